// The other pose in which a flat target looks nearly the same.
#pragma once

#include <optional>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"
#include "tracking/pose/planar_pose.hpp"

namespace catchlight::tracking {

/// A square that stands for a flat target when its two planar poses are sought: parallel to the first tag, in its frame.
struct PlanarSquare {
  glm::dvec3 center_m;
  double size_m;
};

/// The square around all tags; empty where they are not all in the first one's plane: such a board has only one pose.
std::optional<PlanarSquare> planar_square(const std::vector<BundledTag>& tags);

/// The pose that shows the square's corners in nearly the same places, and how far from them, rms, where that is known (else 0).
/// Empty where there is none: the square faces the camera, or is in part behind it.
std::optional<PoseHypothesis> mirrored(const CameraModel& camera, const PlanarSquare& square,
                                       const RigidTransform& camera_from_tag);

}  // namespace catchlight::tracking
