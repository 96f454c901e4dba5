// The trajectory of the camera through a world, as the formats of other programs want it. Private to app/track_export.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "app/settings/scene_settings.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/track.hpp"

namespace catchlight::app {

struct CameraKey {
  std::int64_t frame;
  double time_s;
  glm::dvec3 world_from_camera_m;  ///< translation
  glm::dquat world_from_camera;    ///< rotation, unit; never more than half a turn of the hypersphere from the key before
};

/// The frames that have a pose. World: the tag; camera: OpenCV's (x right, y down, z forward).
std::vector<CameraKey> camera_path_in_tag(const std::vector<TrackRow>& rows);

/// The same in a world whose +y is up, where the camera's y is up and it looks along its -z, as in Nuke and glTF.
std::vector<CameraKey> camera_path_y_up(const std::vector<TrackRow>& rows, const SceneSettings& scene);

/// The world whose +y is up as `probe.up` says. Tag on a table: tag z is world y; on a wall: the axes agree.
glm::dmat3 y_up_from_tag(const SceneSettings& scene);

/// What a pinhole camera centred on the picture sees, between the outer edges of the first and the last row of pixels.
double vertical_fov_rad(const CameraModel& camera);

}  // namespace catchlight::app
