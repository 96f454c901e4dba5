#include "tracking/pose/mirrored_pose.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/rotation.hpp"

namespace catchlight::tracking {
namespace {

/// Exact corners lead both planar solutions to one minimum where the view is nearly frontal; noisy pixels may still have two,
/// turned by the same angle to either side of the line of sight.
std::optional<RigidTransform> tilted_the_other_way(const RigidTransform& camera_from_square) {
  const glm::dvec3 normal = camera_from_square.rotation[2], sight = -glm::normalize(camera_from_square.translation_m);
  const glm::dvec3 half_turn = glm::cross(normal, sight);  // its length is the sine of the tilt
  const double tilt = std::atan2(glm::length(half_turn), glm::dot(normal, sight));
  if (!(glm::length(half_turn) > 1e-6)) return std::nullopt;
  return RigidTransform{rotation_matrix(glm::normalize(half_turn) * (2 * tilt)) * camera_from_square.rotation,
                        camera_from_square.translation_m};
}

}  // namespace

std::optional<PlanarSquare> planar_square(const std::vector<BundledTag>& tags) {
  constexpr double kFlat = 1e-3;  // in sizes of the tag
  glm::dvec3 low(1e9), high(-1e9);
  for (const BundledTag& tag : tags)
    for (const glm::dvec3& corner_m : tag_corners_m(tag.size_m)) {
      const glm::dvec3 point_m = tag.tag_from_this * corner_m;
      if (std::abs(point_m.z) > kFlat * tag.size_m) return std::nullopt;
      low = glm::min(low, point_m);
      high = glm::max(high, point_m);
    }
  return PlanarSquare{(low + high) / 2.0, std::max(high.x - low.x, high.y - low.y)};
}

std::optional<PoseHypothesis> mirrored(const CameraModel& camera, const PlanarSquare& square,
                                       const RigidTransform& camera_from_tag) {
  const RigidTransform tag_from_square{glm::dmat3(1.0), square.center_m};
  const RigidTransform camera_from_square = camera_from_tag * tag_from_square;
  const auto corners_px = project_corners(camera, camera_from_square, square.size_m);
  if (!corners_px) return std::nullopt;
  const auto poses = planar_poses(camera, *corners_px, square.size_m);
  if (poses.size() == 2) return PoseHypothesis{poses[1].camera_from_tag * inverse(tag_from_square), poses[1].reprojection_rms_px};
  const auto turned = tilted_the_other_way(camera_from_square);
  if (!turned) return std::nullopt;
  return PoseHypothesis{*turned * inverse(tag_from_square), 0};
}

}  // namespace catchlight::tracking
