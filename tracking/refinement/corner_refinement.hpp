// Moves a detection's corners to where its four outer edges really are.
#pragma once

#include <array>

#include "catchlight/camera.hpp"
#include "catchlight/luma_view.hpp"
#include "tracking/detection/families.hpp"
#include "tracking/pose/planar_pose.hpp"

namespace catchlight::tracking {

/// A lens blurs light, the camera encodes it afterwards: the middle of an edge in codes is not its middle in light (0.27 px
/// off in sRGB). So codes are made linear, and each outer edge is fitted there, as a straight line in ideal pixels.
struct RefinedCorners {
  Quad corners_px{};                     ///< as seen (distorted), in the order they were given
  std::array<bool, 4> edge_refined{};    ///< edge i joins corners i and i + 1; false: kept as it was given
  std::array<double, 4> edge_blur_px{};  ///< the camera's blur across each refined edge
};

/// `corners_px` within about 1 px of the truth, as the detector gives them.
RefinedCorners refine_corners(const LumaView& luma, const CameraModel& camera, const Quad& corners_px, const TagLayout& layout);

}  // namespace catchlight::tracking
