#include "render/camera/camera_blur.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "shaders/interface.h"

namespace catchlight::render {
namespace {

constexpr double kMinMotion_px = 0.5, kMinDefocus_px2 = 1e-6;

}  // namespace

MotionField fit_motion(const CameraModel& camera, const DistortionLimit& limit, const RigidTransform& camera_from_tag,
                       const TagMotion& motion, std::span<const glm::dvec3> points_tag_m) {
  const auto seen_px = [&](const glm::dvec3& point_camera_m) { return project_px(camera, point_camera_m, &limit).value(); };
  std::vector<glm::dvec2> places, displacements;
  for (const glm::dvec3& point : points_tag_m) {
    const glm::dvec3 middle = camera_from_tag * point;
    const glm::dvec3 half = 0.5 * (glm::cross(motion.turn_rad, middle) + motion.shift_m);
    if (!(middle.z - std::abs(half.z) > 1e-3)) continue;
    places.push_back(seen_px(middle));
    displacements.push_back(seen_px(middle + half) - seen_px(middle - half));
  }
  MotionField field;
  if (places.size() < 3) return field;
  const double share = 1.0 / static_cast<double>(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    field.origin_px += share * places[i];
    field.displacement_px += share * displacements[i];
  }
  glm::dmat2 spread(0.0), together(0.0);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::dvec2 off = places[i] - field.origin_px;
    spread += share * glm::outerProduct(off, off);
    together += share * glm::outerProduct(displacements[i], off);
  }
  // Points on a line do not say what changes across it.
  const double trace = spread[0][0] + spread[1][1];
  if (glm::determinant(spread) > 1e-6 * trace * trace) field.change = together * glm::inverse(spread);
  return field;
}

std::vector<float> discrete_gaussian(double variance, double invisible) {
  const double t = std::clamp(variance, 0.0, kMaxDefocus_px2);
  std::vector<double> weights;
  double sum = 0;
  for (int n = 0; n < DEFOCUS_TAPS && 1 - sum > invisible; ++n) {
    weights.push_back(std::exp(-t) * std::cyl_bessel_i(static_cast<double>(n), t));
    sum += weights.back() * (n == 0 ? 1 : 2);
  }
  std::vector<float> result;
  for (const double weight : weights) result.push_back(static_cast<float>(weight / sum));
  return result;
}

int CameraBlurPlan::reach_px(const PixelRect& rect) const {
  double reach = variance_px2 > 0 ? static_cast<double>(discrete_gaussian(variance_px2).size()) : 0;
  if (!moves) return static_cast<int>(reach);
  double longest = 0;
  for (const MotionField& field : {object, shadow})
    for (const double x : {rect.x, rect.x + rect.width})
      for (const double y : {rect.y, rect.y + rect.height}) longest = std::max(longest, glm::length(field.at({x, y})));
  return static_cast<int>(std::ceil(reach + std::min(longest, kMaxMotion_px) / 2)) + 2;
}

CameraBlurPlan plan_camera_blur(const FrameView& view, const DistortionLimit& limit, const Bounds& box) {
  CameraBlurPlan plan;
  if (view.effects.defocus_px2 > kMinDefocus_px2) plan.variance_px2 = std::min(view.effects.defocus_px2, kMaxDefocus_px2);
  const TagMotion& motion = view.effects.motion;
  if (motion.turn_rad == glm::dvec3(0.0) && motion.shift_m == glm::dvec3(0.0)) return plan;
  if (box.empty()) return plan;
  std::array<glm::dvec3, 9> corners, footprint;
  for (std::size_t i = 0; i < 9; ++i) {
    const glm::dvec3 share = i == 8 ? glm::dvec3(0.5) : glm::dvec3(i & 1, i >> 1 & 1, i >> 2);
    corners[i] = glm::mix(glm::dvec3(box.min_m), glm::dvec3(box.max_m), share);
    footprint[i] = glm::dvec3(glm::dvec2(corners[i]), 0.0);
  }
  plan.object = fit_motion(view.camera, limit, view.camera_from_tag, motion, corners);
  plan.shadow = fit_motion(view.camera, limit, view.camera_from_tag, motion, footprint);
  plan.moves = std::max(glm::length(plan.object.displacement_px), glm::length(plan.shadow.displacement_px)) >= kMinMotion_px;
  return plan;
}

}  // namespace catchlight::render
