#include "app/replay/pose_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <map>

namespace catchlight::app {

namespace {

constexpr double kFlip_deg = 8.0;

glm::dvec2 project(const CameraModel& camera, const glm::dvec3& point_camera_m) {
  return {camera.fx_px * point_camera_m.x / point_camera_m.z + camera.cx_px,
          camera.fy_px * point_camera_m.y / point_camera_m.z + camera.cy_px};
}

double angle_between_deg(const glm::dmat3& a, const glm::dmat3& b) {
  const glm::dmat3 difference = glm::transpose(a) * b;
  const double trace = difference[0][0] + difference[1][1] + difference[2][2];
  return glm::degrees(std::acos(std::clamp((trace - 1.0) / 2.0, -1.0, 1.0)));
}

/// Linear interpolation between order statistics; `values` is sorted on return.
double percentile(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const double position = share * static_cast<double>(values.size() - 1);
  const std::size_t below = static_cast<std::size_t>(position), above = std::min(below + 1, values.size() - 1);
  return values[below] + (position - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace

PoseComparison compare_poses(const std::vector<TrackRow>& ours, const std::vector<TrackRow>& truth, const CameraModel& camera,
                             double tag_size_m) {
  std::map<std::int64_t, const TrackRow*> by_frame;
  for (const TrackRow& row : ours)
    if (row.found) by_frame[row.frame] = &row;

  PoseComparison result;
  std::vector<double> corner_px, translation_mm, rotation_deg;
  const double half = tag_size_m / 2;
  for (const TrackRow& known : truth) {
    if (!known.found) continue;
    ++result.frames;
    const auto found = by_frame.find(known.frame);
    if (found == by_frame.end()) continue;
    ++result.tracked;
    const RigidTransform &a = found->second->camera_from_tag, &b = known.camera_from_tag;
    for (const glm::dvec3 corner : {glm::dvec3{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}})
      corner_px.push_back(glm::distance(project(camera, a * corner), project(camera, b * corner)));
    translation_mm.push_back(1000 * glm::distance(a.translation_m, b.translation_m));
    rotation_deg.push_back(angle_between_deg(a.rotation, b.rotation));
    if (rotation_deg.back() > kFlip_deg) ++result.flips;
  }
  double squares = 0;
  for (const double d : corner_px) squares += d * d;
  result.corner_rms_px = corner_px.empty() ? 0 : std::sqrt(squares / static_cast<double>(corner_px.size()));
  result.corner_p95_px = percentile(corner_px, 0.95);
  result.translation_median_mm = percentile(translation_mm, 0.5);
  result.rotation_median_deg = percentile(rotation_deg, 0.5);
  result.rotation_max_deg = percentile(rotation_deg, 1.0);
  return result;
}

}  // namespace catchlight::app
