#include "app/tools/probe_merge/ball.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "catchlight/error.hpp"
#include "catchlight/projection.hpp"

namespace catchlight::app {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRimPx = 1.5;  ///< so near the silhouette, pixels hold some of the background

}  // namespace

glm::dvec3 ray_through(const CameraModel& camera, const glm::dvec2& px) {
  const auto ideal = undistort_px(camera, px);
  if (!ideal)
    throw Error("the ball's outline lies beyond what the camera file's lens can see; is it the camera of the photograph?");
  return glm::normalize(glm::dvec3((ideal->x - camera.cx_px) / camera.fx_px, (ideal->y - camera.cy_px) / camera.fy_px, 1));
}

std::vector<glm::dvec2> outline_of(const BallCircle& circle) {
  constexpr int kPoints = 64;
  std::vector<glm::dvec2> points;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2 * kPi * i / kPoints;
    points.push_back(circle.centre_px + circle.radius_px * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  return points;
}

BallCircle fit_circle(const std::vector<glm::dvec2>& points_px) {
  // |p|² = 2 c · p + (r² - |c|²), about the points' mean for a good condition.
  glm::dvec2 mean(0);
  for (const glm::dvec2& point : points_px) mean += point / static_cast<double>(points_px.size());
  glm::dmat3 normal(0);
  glm::dvec3 right(0);
  for (const glm::dvec2& point : points_px) {
    const glm::dvec3 row(point - mean, 1);
    normal += glm::outerProduct(row, row);
    right += row * glm::dot(point - mean, point - mean);
  }
  const glm::dvec3 solved = glm::inverse(normal) * right;
  const glm::dvec2 centre = glm::dvec2(solved) / 2.0;
  return {mean + centre, std::sqrt(std::max(0.0, solved.z + glm::dot(centre, centre)))};
}

BallView::BallView(const BallCircle& circle, const std::optional<CameraModel>& camera, const glm::dvec3& axis,
                   double distance_radii)
    : circle_(circle), camera_(camera), axis_(axis), distance_radii_(distance_radii) {
  const double silhouette_rad = std::acos(1 / distance_radii);
  const double usable = std::max(0.5, 1 - kRimPx / circle.radius_px);
  largest_normal_rad_ = std::asin(std::sin(silhouette_rad) * usable);
}

BallView BallView::orthographic(const std::vector<glm::dvec2>& outline_px) {
  return {fit_circle(outline_px), std::nullopt, {0, 0, 1}, std::numeric_limits<double>::infinity()};
}

BallView BallView::perspective(const CameraModel& camera, const std::vector<glm::dvec2>& outline_px) {
  glm::dmat3 normal(0);
  glm::dvec3 right(0);
  for (const glm::dvec2& px : outline_px) {
    const glm::dvec3 ray = ray_through(camera, px);
    normal += glm::outerProduct(ray, ray);
    right += ray;
  }
  const glm::dvec3 cone = glm::inverse(normal) * right;
  const double cosine = 1 / glm::length(cone);
  if (!(cosine < 1)) throw Error("the ball's outline is no circle in front of the camera; give it by hand with --ball");
  return {fit_circle(outline_px), camera, cone * cosine, 1 / std::sqrt(1 - cosine * cosine)};
}

double BallView::normal_angle(double from_camera_rad) const {
  const double distance = distance_radii_;
  double angle = from_camera_rad / 2;
  if (std::isinf(distance)) return angle;
  for (int i = 0; i < 12; ++i) {
    const double sine = std::sin(angle), cosine = std::cos(angle);
    const double value = 2 * angle + std::atan2(sine, distance - cosine) - from_camera_rad;
    const double slope = 2 + (distance * cosine - 1) / (distance * distance - 2 * distance * cosine + 1);
    angle -= value / slope;
    if (std::abs(value) < 1e-13) break;
  }
  return angle;
}

BallSight BallView::sight(const glm::dvec3& direction_camera) const {
  BallSight sight;
  const double towards = std::clamp(-glm::dot(direction_camera, axis_), -1.0, 1.0);
  const glm::dvec3 across = direction_camera + towards * axis_;  // the part square to the axis
  const double across_length = glm::length(across);
  sight.from_camera_rad = std::atan2(across_length, towards);
  double angle = normal_angle(sight.from_camera_rad);
  sight.is_behind = angle > largest_normal_rad_;
  angle = std::min(angle, largest_normal_rad_);
  sight.rim = std::sin(angle) / std::sin(largest_normal_rad_);
  // Straight back any side of the rim will do.
  const glm::dvec3 side =
      across_length > 1e-12 ? across / across_length : glm::normalize(glm::cross(axis_, glm::dvec3(0, 1, 1e-3)));
  if (!camera_) {
    sight.px = circle_.centre_px + circle_.radius_px * std::sin(angle) * glm::dvec2(side);
    return sight;
  }
  const glm::dvec3 point = (distance_radii_ - std::cos(angle)) * axis_ + std::sin(angle) * side;
  sight.px = project_px(*camera_, point).value_or(circle_.centre_px);
  return sight;
}

}  // namespace catchlight::app
