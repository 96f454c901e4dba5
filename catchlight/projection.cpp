#include "catchlight/projection.hpp"

#include <cmath>

namespace catchlight {
namespace {

struct Distorted {
  glm::dvec2 point;
  glm::dmat2 jacobian;  ///< d point / d ideal
};

constexpr double kMaxRadius = 20.0;
constexpr double kMinSlope = 0.1;

double radial_factor(const std::array<double, 8>& k, double r2) {
  return (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
}

/// OpenCV's model on normalised coordinates:
/// p·(1 + k1 r² + k2 r⁴ + k3 r⁶) / (1 + k4 r² + k5 r⁴ + k6 r⁶) + tangential(p1, p2).
Distorted distort(const std::array<double, 8>& k, const glm::dvec2& p) {
  const double x = p.x, y = p.y, r2 = x * x + y * y;
  const double radial = radial_factor(k, r2), denominator = 1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
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

/// The model beyond its limit: a line in the direction from the axis, with the tangential part of the limit.
Distorted continued(const std::array<double, 8>& k, const DistortionLimit& limit, const glm::dvec2& p) {
  const double radius = glm::length(p);
  const glm::dvec2 direction = p / radius;
  const Distorted at_limit = distort(k, direction * limit.radius);
  const double beyond = limit.slope * (radius - limit.radius);
  const glm::dmat2 along = glm::outerProduct(direction, direction), across = glm::dmat2(1.0) - along;
  return {at_limit.point + direction * beyond,
          limit.slope * along + (limit.radius * at_limit.jacobian + glm::dmat2(beyond)) * across / radius};
}

Distorted distort(const CameraModel& camera, const glm::dvec2& p, const DistortionLimit* limit) {
  if (limit && glm::length(p) > limit->radius) return continued(camera.distortion, *limit, p);
  return distort(camera.distortion, p);
}

glm::dvec2 normalized(const CameraModel& camera, const glm::dvec2& px) {
  return {(px.x - camera.cx_px) / camera.fx_px, (px.y - camera.cy_px) / camera.fy_px};
}

glm::dvec2 pixels(const CameraModel& camera, const glm::dvec2& p) {
  return {p.x * camera.fx_px + camera.cx_px, p.y * camera.fy_px + camera.cy_px};
}

}  // namespace

DistortionLimit distortion_limit(const CameraModel& camera) {
  constexpr double kStep = 1.0 / 256;
  const auto radial = [&](double r) { return r * radial_factor(camera.distortion, r * r); };
  if (!camera.has_distortion()) return {kMaxRadius, kMaxRadius, 1.0};
  double r = 0.0, slope = 1.0;
  while (r < kMaxRadius) {
    const double next_slope = (radial(r + kStep) - radial(r)) / kStep;
    // Written so that a NaN (a pole of the denominator) ends the walk as well.
    if (!(next_slope >= kMinSlope && next_slope < 100.0)) break;
    r += kStep;
    slope = next_slope;
  }
  return {r, radial(r), slope};
}

glm::dvec2 distort_px(const CameraModel& camera, const glm::dvec2& ideal_px, const DistortionLimit* limit) {
  if (!camera.has_distortion()) return ideal_px;
  return pixels(camera, distort(camera, normalized(camera, ideal_px), limit).point);
}

std::optional<glm::dvec2> undistort_px(const CameraModel& camera, const glm::dvec2& distorted_px, const DistortionLimit* limit) {
  if (!camera.has_distortion()) return distorted_px;
  const glm::dvec2 target = normalized(camera, distorted_px);
  const double tolerance = 1e-9 / std::max(camera.fx_px, camera.fy_px);
  glm::dvec2 guess = target;
  for (int step = 0; step < 20; ++step) {
    const Distorted at_guess = distort(camera, guess, limit);
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

std::optional<glm::dvec2> project_px(const CameraModel& camera, const glm::dvec3& point_camera_m, const DistortionLimit* limit) {
  const auto ideal_px = project_ideal_px(camera, point_camera_m);
  if (!ideal_px) return std::nullopt;
  return distort_px(camera, *ideal_px, limit);
}

glm::dvec3 distorted(const CameraModel& camera, const DistortionLimit& limit, const glm::dvec3& p) {
  const double rho = std::hypot(p.x, p.y);
  if (p.z > 0 && rho <= limit.radius * p.z) return {distort(camera.distortion, glm::dvec2(p) / p.z).point * p.z, p.z};
  if (rho == 0) return p;
  const glm::dvec2 direction = glm::dvec2(p) / rho;
  // Continued as above, times z.
  const glm::dvec2 at_limit = distort(camera.distortion, direction * limit.radius).point;
  return {at_limit * p.z + direction * (limit.slope * (rho - limit.radius * p.z)), p.z};
}

}  // namespace catchlight
