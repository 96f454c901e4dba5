// What the camera did to the light, frame by frame, read off the tag.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>

#include "app/settings/scene_settings.hpp"
#include "tracking/camera/photometry.hpp"

namespace catchlight::app {

/// How white paper on the tag comes out: exposed linear value (1 = sensor white) = white * albedo + black, per channel.
/// Independent of the probe, so that a track holds for any light put to it.
struct TagExposure {
  glm::dvec3 white{0.75};  ///< until the tag has been seen: paper of albedo 0.8 at 0.6, as cameras meter it
  glm::dvec3 black{0.0};   ///< flare and black level
};

/// What a channel's exposure was read from, from best to worst.
enum class ExposureSource {
  tag,    ///< white and black cells
  black,  ///< white clipped: the black cells, taking them for free of flare
  nothing,
};

struct TagReading {
  TagExposure exposure;  ///< as by default where a channel's source is nothing
  std::array<ExposureSource, 3> sources{ExposureSource::nothing, ExposureSource::nothing, ExposureSource::nothing};
};

/// Two equations, two unknowns per channel: the white cells and the black cells are surfaces of known albedo in the same light.
TagReading read_exposure(const tracking::TagPhotometry& photometry, double white_albedo, double black_albedo);

/// Exposed linear value of one unit of the probe's radiance. `match`: the paper under the probe's own irradiance E must come out
/// as it did, white / (E/pi); `fixed`: 1. Both times 2^ev.
glm::dvec3 exposure_gain(const SceneSettings::Exposure& settings, const glm::dvec3& white,
                         const glm::dvec3& tag_irradiance_over_pi);

}  // namespace catchlight::app
