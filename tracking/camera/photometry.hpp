// What the camera made of the tag's own white and black: the reference for exposure matching.
#pragma once

#include <optional>

#include "catchlight/camera.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/track.hpp"
#include "tracking/camera/pixel_light.hpp"

namespace catchlight::tracking {

/// Linear RGB of the print's white and black, free of what the lens blurs into each other.
struct TagPhotometry {
  glm::dvec3 white_linear{0.0};
  glm::dvec3 black_linear{0.0};
  int white_pixels = 0, black_pixels = 0;
  glm::bvec3 is_clipped{false};  ///< the channel's white is clipped: `white_linear` is only a lower bound
};

/// The part of the picture that the print is seen in.
PixelRect photometry_region(const CameraModel& camera, const RigidTransform& camera_from_tag, const TagTarget& target);

/// Measures in the middles of the cells. Where these are too small, and the blur is known (direct refinement tells it), it takes
/// all pixels of the tag: each is so much white and so much black by the model of tag_pattern.hpp. Empty where neither can be
/// done, or white is not brighter than black. A quarter of the cells may be clipped, shadowed, lit or stained at either end
/// without harm, channel by channel; where more of the white is clipped, `is_clipped` says so (black is 0 where it is not known
/// either).
std::optional<TagPhotometry> measure_photometry(const PixelLight& light, const CameraModel& camera,
                                                const RigidTransform& camera_from_tag, const TagTarget& target,
                                                const std::optional<Covariance2>& blur_px2 = {});

}  // namespace catchlight::tracking
