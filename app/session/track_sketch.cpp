#include "app/session/track_sketch.hpp"

#include <cstdio>
#include <optional>

#include "catchlight/projection.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/util/enum_names.hpp"

namespace catchlight::app {
namespace {

constexpr Rgb kWhite{255, 255, 255}, kMagenta{255, 0, 255}, kLightGreen{140, 255, 140}, kOrange{255, 180, 60},
    kLightRed{255, 150, 150};
constexpr Rgb kAxisColors[] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}};

/// The pixel at which the lens shows a point. Empty behind the camera, and beyond the field in which the lens model is one to
/// one: there it would fold back into the picture.
std::optional<glm::dvec2> seen_px(const CameraModel& camera, const glm::dvec3& point_camera_m) {
  const auto ideal_px = project_ideal_px(camera, point_camera_m);
  const auto px = project_px(camera, point_camera_m);
  if (!px || glm::length(*px) > 1e5) return std::nullopt;  // far beyond any picture
  const auto back_px = undistort_px(camera, *px);
  return back_px && glm::distance(*back_px, *ideal_px) < 0.01 ? px : std::nullopt;
}

/// Adds those pieces that can be seen of a straight line on or above the tag; the lens may bend it.
void add_line(std::vector<Stroke>& strokes, const CameraModel& camera, const RigidTransform& camera_from_tag,
              const glm::dvec3& from_m, const glm::dvec3& to_m, const Rgb& color) {
  constexpr int kPieces = 16;
  Stroke stroke{{}, color};
  for (int i = 0; i <= kPieces; ++i) {
    const auto px = seen_px(camera, camera_from_tag * glm::mix(from_m, to_m, static_cast<double>(i) / kPieces));
    if (px) {
      stroke.points_px.push_back(*px);
      continue;
    }
    if (stroke.points_px.size() > 1) strokes.push_back(stroke);
    stroke.points_px.clear();
  }
  if (stroke.points_px.size() > 1) strokes.push_back(stroke);
}

const Rgb& color_of(TrackState state) {
  if (state == TrackState::lost) return kLightRed;
  return state == TrackState::tracking ? kLightGreen : kOrange;
}

}  // namespace

std::vector<Stroke> outline_strokes(const CameraModel& camera, const RigidTransform& camera_from_tag, double tag_size_m) {
  const double half_m = tag_size_m / 2;
  return plane_strokes(camera, camera_from_tag, glm::dvec2(-half_m), glm::dvec2(half_m), kWhite);
}

std::vector<Stroke> axis_strokes(const CameraModel& camera, const RigidTransform& camera_from_tag, double tag_size_m) {
  std::vector<Stroke> strokes;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 end_m(0.0);
    end_m[axis] = tag_size_m / 2;
    add_line(strokes, camera, camera_from_tag, glm::dvec3(0.0), end_m, kAxisColors[axis]);
  }
  return strokes;
}

std::vector<Stroke> corner_strokes(const CameraModel& camera, const RigidTransform& camera_from_tag, double tag_size_m,
                                   double arm_px) {
  std::vector<Stroke> strokes;
  for (const glm::dvec3& corner_m : tag_corners_m(tag_size_m)) {
    const auto px = seen_px(camera, camera_from_tag * corner_m);
    if (!px) continue;
    for (const glm::dvec2& arm : {glm::dvec2(arm_px, 0), glm::dvec2(0, arm_px)})
      strokes.push_back({{*px - arm, *px + arm}, kMagenta});
  }
  return strokes;
}

std::vector<Stroke> plane_strokes(const CameraModel& camera, const RigidTransform& camera_from_tag, const glm::dvec2& min_m,
                                  const glm::dvec2& max_m, const Rgb& color) {
  const glm::dvec3 corners_m[] = {{min_m, 0}, {max_m.x, min_m.y, 0}, {max_m, 0}, {min_m.x, max_m.y, 0}};
  std::vector<Stroke> strokes;
  for (int i = 0; i < 4; ++i) add_line(strokes, camera, camera_from_tag, corners_m[i], corners_m[(i + 1) % 4], color);
  return strokes;
}

std::vector<SketchLine> state_lines(const TrackRow& row) {
  std::vector<SketchLine> lines = {{"frame " + std::to_string(row.frame) + "  " + name_of(row.state), color_of(row.state)}};
  if (row.state != TrackState::tracking) return lines;
  char text[80];
  std::snprintf(text, sizeof text, "corners +-%.3f px  residual %.1f codes  ambiguity %.2f", row.corner_sigma_px, row.noise_codes,
                row.ambiguity);
  lines.push_back({text, kWhite});
  return lines;
}

}  // namespace catchlight::app
