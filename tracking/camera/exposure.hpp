// What the camera did to the light of one frame, read off the tag.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "tracking/camera/photometry.hpp"

namespace catchlight::tracking {

/// What share of the light the tag's print sends back.
struct TagAlbedo {
  double white = 0.8, black = 0.04;
};

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
TagReading read_exposure(const TagPhotometry& photometry, const TagAlbedo& albedo);

}  // namespace catchlight::tracking
