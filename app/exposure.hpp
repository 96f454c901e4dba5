// What the camera did to the light, frame by frame, read off the tag.
#pragma once

#include <array>
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

/// Where a channel's exposure comes from, from best to worst.
enum class ExposureSource {
  tag,      ///< white and black cells
  surface,  ///< white clipped: the brightening of the surface and of the black cells since white was last read
  black,    ///< white clipped since the beginning: the black cells, taking them for free of flare
  held,     ///< nothing to be read: the last answer
};

struct MatchedExposure {
  TagExposure exposure;
  std::array<ExposureSource, 3> sources{ExposureSource::held, ExposureSource::held, ExposureSource::held};
  bool is_held() const { return sources[0] == ExposureSource::held; }
};

/// Two equations, two unknowns per channel: the white cells and the black cells are surfaces of known albedo in the same light.
/// A channel whose white is clipped is measured against the last one that was not; a frame without a trustworthy tag keeps the
/// last answer. Nothing is accumulated, so nothing drifts.
class ExposureMatcher {
 public:
  ExposureMatcher(double white_albedo, double black_albedo) : white_albedo_(white_albedo), black_albedo_(black_albedo) {}

  /// `brightening`: of what is not clipped, per channel, since its white was last read; 0: not known. Used where
  /// `photometry->is_clipped`.
  MatchedExposure update(const std::optional<tracking::TagPhotometry>& photometry,
                         const glm::dvec3& brightening = glm::dvec3(0.0));

 private:
  ExposureSource update_channel(const tracking::TagPhotometry& photometry, double brightening, int channel);

  double white_albedo_, black_albedo_;
  TagExposure current_, measured_;
  glm::bvec3 is_measured_{false};
};

/// Exposed linear value of one unit of the probe's radiance. `match`: the paper under the probe's own irradiance E must come out
/// as it did, white / (E/pi); `fixed`: 1. Both times 2^ev.
glm::dvec3 exposure_gain(const SceneSettings::Exposure& settings, const glm::dvec3& white,
                         const glm::dvec3& tag_irradiance_over_pi);

}  // namespace catchlight::app
