// A square's corners, and the two poses that they allow.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/rigid_transform.hpp"

namespace catchlight::tracking {

using Quad = std::array<glm::dvec2, 4>;

struct PoseHypothesis {
  RigidTransform camera_from_tag;
  double reprojection_rms_px = 0;  ///< over the four corners, as seen (distorted)
};

/// A tag's corners as seen, in the order of tag_corners_m(); empty where one is behind the camera.
std::optional<Quad> project_corners(const CameraModel& camera, const RigidTransform& camera_from_tag, double size_m);

/// Infinitesimal plane-based pose estimation (Collins & Bartoli 2014), each solution refined by Levenberg-Marquardt on the
/// reprojection error in pixels. At most two, the better first; only those with the tag in front of the camera and its
/// printed face towards it; one where both solutions are the same. Empty for corners that no such pose explains.
std::vector<PoseHypothesis> planar_poses(const CameraModel& camera, const Quad& corners_px, double size_m);

}  // namespace catchlight::tracking
