#include "app/tools/replay/pose_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"

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

int corners_in_picture(const CameraModel& camera, const RigidTransform& camera_from_tag, double tag_size_m) {
  int inside = 0;
  for (const glm::dvec3& corner_m : tag_corners_m(tag_size_m)) {
    const glm::dvec3 point_m = camera_from_tag * corner_m;
    const glm::dvec2 px = project(camera, point_m);
    inside += point_m.z > 0 && px.x >= 0 && px.y >= 0 && px.x <= camera.width_px - 1 && px.y <= camera.height_px - 1;
  }
  return inside;
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
  for (const TrackRow& known : truth) {
    if (!known.found) continue;
    const auto found = by_frame.find(known.frame);
    const int inside = corners_in_picture(camera, known.camera_from_tag, tag_size_m);
    if (inside == 0 && found != by_frame.end()) ++result.false_positives;
    if (inside < 4) continue;
    ++result.frames;
    if (found == by_frame.end()) continue;
    ++result.tracked;
    const RigidTransform &a = found->second->camera_from_tag, &b = known.camera_from_tag;
    for (const glm::dvec3& corner : tag_corners_m(tag_size_m))
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
