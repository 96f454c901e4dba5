// What the camera made of the tag's own white and black: the reference for exposure matching.
#pragma once

#include <optional>
#include <span>

#include "catchlight.hpp"
#include "tracking/tracker.hpp"

namespace catchlight::tracking {

/// Part of a frame in linear light: RGB float triples, row-major, `rect` says where in the frame. 1 = sensor white.
struct LinearPatch {
  PixelRect rect;
  std::span<const float> rgb;
};

/// Mean linear RGB of the interior of white and black cells, away from edges that the lens blurs.
struct TagPhotometry {
  glm::dvec3 white_linear{0.0};
  glm::dvec3 black_linear{0.0};
  int white_pixels = 0, black_pixels = 0;
};

/// The pixels that measure_photometry() wants to see.
PixelRect photometry_region(const CameraModel& camera, const RigidTransform& camera_from_tag, const TagTarget& target);

/// Empty where the tag is too small, or too much of its white is clipped in any channel, to be trusted.
std::optional<TagPhotometry> measure_photometry(const LinearPatch& patch, const CameraModel& camera,
                                                const RigidTransform& camera_from_tag, const TagTarget& target);

}  // namespace catchlight::tracking
