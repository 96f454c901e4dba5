// Photographs of a mirror ball in light that is known in closed form. Shares no geometry with the product: each pixel's rays are
// met with the ball and mirrored on it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/image.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"

namespace catchlight::tests {

/// Radiance of a direction (unit length, probe frame).
using Environment = std::function<glm::dvec3(const glm::dvec3&)>;

/// A room: bright above, dim below, a warm window, a blue one, a small lamp 2^12 times as bright as the floor.
glm::dvec3 room(const glm::dvec3& direction);

/// 800x600, focal length 1000 px.
CameraModel ball_camera();

struct BallScene {
  CameraModel camera = ball_camera();
  glm::dvec3 centre_camera_m{0, 0, 1};
  double radius_m = 0.05;
  glm::dmat3 probe_from_camera{1.0};
  Environment environment = room;
  double photographer_rad = 0;  ///< within this angle of the camera's direction, a bright magenta person is reflected
  std::optional<RigidTransform> camera_from_tag;
  TagTarget tag;
};

/// Scene-linear; grey around the ball, and the tag on it where there is one.
Image photograph(const BallScene& scene);

/// Normalised code of light; rises from (0, 0) to (1, 1).
double film_code(double light);
/// The inverse of film_code().
double film_light(double code);

/// 8-bit PNGs of radiance · time, through film_code() with noise and clipping; returns the files' names.
std::vector<std::string> write_bracket(const Image& radiance, const std::vector<double>& times_s, double noise_codes,
                                       const std::string& name_start);

}  // namespace catchlight::tests
