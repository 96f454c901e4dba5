// What the camera did to the light, frame by frame, read off the tag.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "app/scene_settings.hpp"
#include "tracking/photometry.hpp"

namespace catchlight::app {

/// How white paper on the tag comes out: exposed linear value (1 = sensor white) = white * albedo + black, per channel.
/// Independent of the probe, so that a track holds for any light put to it.
struct TagExposure {
  glm::dvec3 white{0.75};  ///< until the tag has been seen: paper of albedo 0.8 at 0.6, as cameras meter it
  glm::dvec3 black{0.0};   ///< flare and black level
};

/// Two equations, two unknowns per channel: the white cells and the black cells are surfaces of known albedo in the same light.
/// A frame without a trustworthy tag keeps the last answer; nothing is accumulated, so nothing drifts.
class ExposureMatcher {
 public:
  ExposureMatcher(double white_albedo, double black_albedo) : white_albedo_(white_albedo), black_albedo_(black_albedo) {}

  TagExposure update(const std::optional<tracking::TagPhotometry>& photometry);

 private:
  double white_albedo_, black_albedo_;
  TagExposure current_;
};

/// Exposed linear value of one unit of the probe's radiance. `match`: the paper under the probe's own irradiance E must come out
/// as it did, white / (E/pi); `fixed`: 1. Both times 2^ev.
glm::dvec3 exposure_gain(const SceneSettings::Exposure& settings, const glm::dvec3& white,
                         const glm::dvec3& tag_irradiance_over_pi);

}  // namespace catchlight::app
