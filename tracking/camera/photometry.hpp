// What the camera made of the tag's own white and black: the reference for exposure matching.
#pragma once

#include <optional>

#include "catchlight/camera.hpp"
#include "catchlight/code_view.hpp"
#include "catchlight/frame_image.hpp"
#include "catchlight/light_table.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/track.hpp"

namespace catchlight::tracking {

/// A frame's light, pixel by pixel as it is asked for: linear RGB of Rec. 709's primaries, 1 = sensor white.
struct PixelLight {
  CodeView codes;
  LightTable light_of_code;
  glm::mat3 rec709_from_frame{1.0f};
  glm::dvec3 clipping_linear;  ///< light of the clipping level: at or above, the true value is unknown

  /// The nearest pixel's; empty outside the picture.
  std::optional<glm::vec3> at(const glm::dvec2& seen_px) const;
};

PixelLight pixel_light(const FrameImage& frame);

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
