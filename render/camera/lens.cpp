#include "render/camera/lens.hpp"

#include <algorithm>
#include <cmath>

namespace catchlight::render {
namespace {

constexpr double kMaxRadius = 20.0;
constexpr double kMinSlope = 0.1;

double radial_factor(const CameraModel& camera, double r2) {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = camera.distortion;
  return (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)));
}

glm::dvec2 tangential(const CameraModel& camera, const glm::dvec2& p) {
  const double p1 = camera.distortion[2], p2 = camera.distortion[3], r2 = glm::dot(p, p);
  return {2 * p1 * p.x * p.y + p2 * (r2 + 2 * p.x * p.x), p1 * (r2 + 2 * p.y * p.y) + 2 * p2 * p.x * p.y};
}

}  // namespace

glm::dmat4 clip_from_camera(const CameraModel& camera, double near_m) {
  const double w = camera.width_px, h = camera.height_px;
  glm::dmat4 clip(0.0);
  clip[0][0] = 2 * camera.fx_px / w;
  clip[1][1] = 2 * camera.fy_px / h;
  clip[2][0] = (2 * camera.cx_px + 1) / w - 1;
  clip[2][1] = (2 * camera.cy_px + 1) / h - 1;
  clip[2][3] = 1;
  clip[3][2] = near_m;
  return clip;
}

LensLimit lens_limit(const CameraModel& camera) {
  constexpr double kStep = 1.0 / 256;
  const auto radial = [&](double r) { return r * radial_factor(camera, r * r); };
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

glm::dvec3 distorted(const CameraModel& camera, const LensLimit& limit, const glm::dvec3& p) {
  const double rho = std::hypot(p.x, p.y);
  if (p.z > 0 && rho <= limit.radius * p.z) {
    const glm::dvec2 n = glm::dvec2(p) / p.z;
    return {(n * radial_factor(camera, glm::dot(n, n)) + tangential(camera, n)) * p.z, p.z};
  }
  if (rho == 0) return p;
  const glm::dvec2 direction = glm::dvec2(p) / rho;
  const double radius = limit.distorted * p.z + limit.slope * (rho - limit.radius * p.z);
  return {direction * radius + tangential(camera, direction * limit.radius) * p.z, p.z};
}

PixelRect visible_rect(const CameraModel& camera, const RigidTransform& camera_from_tag, const Bounds& box, double near_m) {
  constexpr int kSteps = 8;
  const glm::dvec3 min_m(box.min_m), max_m(box.max_m);
  const PixelRect picture{0, 0, camera.width_px, camera.height_px};
  const LensLimit limit = lens_limit(camera);
  glm::dvec2 low(1e30), high(-1e30);
  int in_front = 0, behind = 0;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      for (int k = 0; k <= kSteps; ++k) {
        const bool on_surface = i % kSteps == 0 || j % kSteps == 0 || k % kSteps == 0;
        if (!on_surface) continue;
        const glm::dvec3 p = camera_from_tag * glm::mix(min_m, max_m, glm::dvec3(i, j, k) / double{kSteps});
        if (p.z < near_m) {
          ++behind;
          continue;
        }
        ++in_front;
        const glm::dvec3 d = distorted(camera, limit, p);
        const glm::dvec2 pixel(camera.fx_px * d.x / d.z + camera.cx_px, camera.fy_px * d.y / d.z + camera.cy_px);
        low = glm::min(low, pixel);
        high = glm::max(high, pixel);
      }
    }
  }
  if (in_front == 0) return {};
  if (behind > 0) return picture;
  const glm::dvec2 border = glm::dvec2(2.0) + (camera.has_distortion() ? (high - low) / 32.0 : glm::dvec2(0.0));
  // Clamped while still floating: a point near the camera's plane may project beyond what an int holds.
  const glm::dvec2 size(camera.width_px, camera.height_px);
  const glm::dvec2 first = glm::clamp(glm::floor(low - border), glm::dvec2(0), size);
  const glm::dvec2 last = glm::clamp(glm::ceil(high + border) + 1.0, glm::dvec2(0), size);
  const PixelRect rect{int(first.x), int(first.y), int(last.x - first.x), int(last.y - first.y)};
  return rect.empty() ? PixelRect{} : rect;
}

}  // namespace catchlight::render
