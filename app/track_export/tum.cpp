#include "app/track_export/camera_trajectory.hpp"
#include "app/track_export/formats.hpp"
#include "catchlight/track.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {

std::string tum_text(const std::vector<TrackRow>& rows) {
  std::string text =
      "# Path of the camera, metres and seconds; frames without a pose are left out.\n"
      "# World: the tag, x right and y up as it is read, z out of the printed face.\n"
      "# Camera: x right, y down, z forward; the quaternion turns its axes to the world's.\n"
      "# timestamp tx ty tz qx qy qz qw\n";
  for (const CameraKey& key : camera_path_in_tag(rows)) {
    const glm::dvec3& t = key.world_from_camera_m;
    const glm::dquat& q = key.world_from_camera;
    text += number_text(key.time_s);
    for (const double value : {t.x, t.y, t.z, q.x, q.y, q.z, q.w}) text += ' ' + number_text(value);
    text += '\n';
  }
  return text;
}

}  // namespace catchlight::app
