#include <cmath>
#include <numbers>

#include "app/track_export/camera_trajectory.hpp"
#include "app/track_export/formats.hpp"
#include "catchlight/track.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;

/// The angle plus whole turns that is nearest to `previous_rad`.
double unwrapped(double angle_rad, double previous_rad) {
  return angle_rad + kTurn_rad * std::round((previous_rad - angle_rad) / kTurn_rad);
}

/// The angles about x and z that, with this one about y, make `rotation` = Ry Rx Rz, near the previous ones. They come from
/// Ry^-1 rotation = Rx Rz, which is well conditioned in every position.
glm::dvec3 angles_around(const glm::dmat3& rotation, double y_rad, const glm::dvec3& previous_rad) {
  const double c = std::cos(y_rad), s = std::sin(y_rad);
  const glm::dmat3 inverse_y(glm::dvec3(c, 0, s), glm::dvec3(0, 1, 0), glm::dvec3(-s, 0, c));
  const glm::dmat3 m = inverse_y * rotation;  // m[column][row]
  return {unwrapped(std::atan2(-m[2][1], m[2][2]), previous_rad.x), unwrapped(y_rad, previous_rad.y),
          unwrapped(std::atan2(-m[1][0], m[0][0]), previous_rad.z)};
}

/// That of the two sets of angles for this rotation which is nearer to the previous frame's. Where the camera looks straight up
/// or down only a sum of y and z is determined: y stays.
glm::dvec3 zxy_angles(const glm::dmat3& rotation, const glm::dvec3& previous_rad) {
  constexpr double kVertical = 1e-9;  // cosine of x below which rounding decides about y
  const double sin_y = rotation[2][0], cos_y = rotation[2][2];
  const bool is_vertical = std::hypot(sin_y, cos_y) < kVertical;
  const double y_rad = is_vertical ? previous_rad.y : std::atan2(sin_y, cos_y);
  const glm::dvec3 a = angles_around(rotation, y_rad, previous_rad),
                   b = angles_around(rotation, y_rad + kTurn_rad / 2, previous_rad);
  return is_vertical || glm::distance(a, previous_rad) <= glm::distance(b, previous_rad) ? a : b;
}

}  // namespace

std::string chan_text(const std::vector<TrackRow>& rows, const Shot& shot) {
  const std::int64_t offset = shot.is_sequence ? 0 : 1;
  const double fov_deg = glm::degrees(vertical_fov_rad(shot.camera));
  std::string text;
  glm::dvec3 angles_rad(0.0);
  for (const CameraKey& key : camera_path_y_up(rows, shot.scene)) {
    angles_rad = zxy_angles(glm::mat3_cast(key.world_from_camera), angles_rad);
    text += std::to_string(key.frame + offset);
    for (int i = 0; i < 3; ++i) text += ' ' + number_text(key.world_from_camera_m[i]);
    for (int i = 0; i < 3; ++i) text += ' ' + number_text(glm::degrees(angles_rad[i]));
    text += ' ' + number_text(fov_deg) + '\n';
  }
  return text;
}

}  // namespace catchlight::app
