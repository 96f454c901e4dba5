#include "app/track_export/camera_trajectory.hpp"

#include "catchlight/rigid_transform.hpp"
#include "render/probe/probe.hpp"

namespace catchlight::app {
namespace {

std::vector<CameraKey> camera_trajectory_keys(const std::vector<TrackRow>& rows, const glm::dmat3& world_from_tag,
                                              const glm::dmat3& tracked_from_camera) {
  std::vector<CameraKey> keys;
  for (const TrackRow& row : rows) {
    if (!row.found) continue;
    const RigidTransform tag_from_camera = inverse(row.camera_from_tag);
    CameraKey key{row.frame, row.time_s, world_from_tag * tag_from_camera.translation_m,
                  glm::normalize(glm::quat_cast(world_from_tag * tag_from_camera.rotation * tracked_from_camera))};
    // q and -q are the same rotation, but what lies between two keys is not.
    if (!keys.empty() && glm::dot(key.world_from_camera, keys.back().world_from_camera) < 0)
      key.world_from_camera = -key.world_from_camera;
    keys.push_back(key);
  }
  return keys;
}

}  // namespace

std::vector<CameraKey> camera_path_in_tag(const std::vector<TrackRow>& rows) {
  return camera_trajectory_keys(rows, glm::dmat3(1.0), glm::dmat3(1.0));
}

std::vector<CameraKey> camera_path_y_up(const std::vector<TrackRow>& rows, const SceneSettings& scene) {
  const glm::dmat3 tracked_from_camera(glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, -1));
  return camera_trajectory_keys(rows, y_up_from_tag(scene), tracked_from_camera);
}

glm::dmat3 y_up_from_tag(const SceneSettings& scene) {
  return glm::transpose(render::tag_from_probe(scene.probe.up, 0));
}

double vertical_fov_rad(const CameraModel& camera) {
  return 2 * std::atan(camera.height_px / (2 * camera.fy_px));
}

}  // namespace catchlight::app
