// What the camera did to the light, frame by frame, read off the tag.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "tracking/photometry.hpp"

namespace catchlight::app {

/// Exposed linear value (1 = sensor white) = gain * radiance + black, per channel.
struct FrameExposure {
  glm::dvec3 gain{1.0};
  glm::dvec3 black{0.0};
};

/// `match`: the tag's white and black cells are surfaces of known albedo under the probe's own irradiance E, so
///   white = gain * white_albedo * E/pi + black,   black_cell = gain * black_albedo * E/pi + black.
/// Two equations, two unknowns per channel. A frame without a trustworthy tag keeps the last answer; nothing is accumulated, so
/// nothing drifts. `fixed`: gain 2^ev, no black.
class ExposureMatcher {
 public:
  struct Settings {
    bool match = true;
    double ev = 0;  ///< added on top, in stops
    double white_albedo = 0.8, black_albedo = 0.04;
  };

  /// `tag_irradiance_over_pi`: radiance of a white Lambertian surface in the tag's place.
  ExposureMatcher(const Settings& settings, const glm::dvec3& tag_irradiance_over_pi);

  FrameExposure update(const std::optional<tracking::TagPhotometry>& photometry);

  /// False until the first frame that showed a trustworthy tag (always true for `fixed`).
  bool matched() const { return matched_; }

 private:
  Settings settings_;
  glm::dvec3 tag_irradiance_over_pi_;
  FrameExposure current_;
  bool matched_ = false;
};

}  // namespace catchlight::app
