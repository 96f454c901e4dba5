#include "tracking/camera/lens.hpp"

namespace catchlight::tracking {
namespace {

struct Distorted {
  glm::dvec2 point;
  glm::dmat2 jacobian;  ///< d point / d ideal
};

/// OpenCV's model on normalised coordinates:
/// p·(1 + k1 r² + k2 r⁴ + k3 r⁶) / (1 + k4 r² + k5 r⁴ + k6 r⁶) + tangential(p1, p2).
Distorted distort(const std::array<double, 8>& k, const glm::dvec2& p) {
  const double x = p.x, y = p.y, r2 = x * x + y * y;
  const double numerator = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  const double denominator = 1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
  const double radial = numerator / denominator;
  const double numerator_slope = k[0] + r2 * (2 * k[1] + r2 * 3 * k[4]);
  const double denominator_slope = k[5] + r2 * (2 * k[6] + r2 * 3 * k[7]);
  const double slope = 2 * (numerator_slope - radial * denominator_slope) / denominator;  // d radial / d r, over r
  const double p1 = k[2], p2 = k[3];

  Distorted result;
  result.point = {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
  const double cross = x * y * slope + 2 * p1 * x + 2 * p2 * y;
  result.jacobian[0] = {radial + x * x * slope + 2 * p1 * y + 6 * p2 * x, cross};
  result.jacobian[1] = {cross, radial + y * y * slope + 6 * p1 * y + 2 * p2 * x};
  return result;
}

glm::dvec2 normalized(const CameraModel& camera, const glm::dvec2& px) {
  return {(px.x - camera.cx_px) / camera.fx_px, (px.y - camera.cy_px) / camera.fy_px};
}

glm::dvec2 pixels(const CameraModel& camera, const glm::dvec2& p) {
  return {p.x * camera.fx_px + camera.cx_px, p.y * camera.fy_px + camera.cy_px};
}

}  // namespace

glm::dvec2 distort_px(const CameraModel& camera, const glm::dvec2& ideal_px) {
  if (!camera.has_distortion()) return ideal_px;
  return pixels(camera, distort(camera.distortion, normalized(camera, ideal_px)).point);
}

std::optional<glm::dvec2> undistort_px(const CameraModel& camera, const glm::dvec2& distorted_px) {
  if (!camera.has_distortion()) return distorted_px;
  const glm::dvec2 target = normalized(camera, distorted_px);
  const double tolerance = 1e-9 / std::max(camera.fx_px, camera.fy_px);
  glm::dvec2 guess = target;
  for (int step = 0; step < 20; ++step) {
    const Distorted at_guess = distort(camera.distortion, guess);
    const glm::dvec2 residual = at_guess.point - target;
    // Beyond the radius where the lens model folds back, a solution would be a mirror image of the true one.
    if (!(glm::determinant(at_guess.jacobian) > 0)) return std::nullopt;
    if (glm::length(residual) <= tolerance) return pixels(camera, guess);
    guess -= glm::inverse(at_guess.jacobian) * residual;
  }
  return std::nullopt;
}

glm::dmat2 distortion_jacobian(const CameraModel& camera, const glm::dvec2& ideal_px) {
  glm::dmat2 jacobian = distort(camera.distortion, normalized(camera, ideal_px)).jacobian;
  jacobian[0].y *= camera.fy_px / camera.fx_px;
  jacobian[1].x *= camera.fx_px / camera.fy_px;
  return jacobian;
}

std::optional<glm::dvec2> project_ideal_px(const CameraModel& camera, const glm::dvec3& point_camera_m) {
  if (!(point_camera_m.z > 0)) return std::nullopt;
  return pixels(camera, glm::dvec2(point_camera_m) / point_camera_m.z);
}

std::optional<glm::dvec2> project_px(const CameraModel& camera, const glm::dvec3& point_camera_m) {
  const auto ideal_px = project_ideal_px(camera, point_camera_m);
  if (!ideal_px) return std::nullopt;
  return distort_px(camera, *ideal_px);
}

}  // namespace catchlight::tracking
