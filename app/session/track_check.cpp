#include "app/session/track_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "catchlight/projection.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

constexpr double kMaxDistance_px = 1;

std::string size_text(const CameraModel& camera) {
  return std::to_string(camera.width_px) + "x" + std::to_string(camera.height_px);
}

std::string tag_text(const PrintedTag& tag) {
  return tag.family + " #" + std::to_string(tag.id) + " of " + number_text(1000 * tag.size_m) + " mm";
}

void check_camera(const std::string& path, const CameraModel& tracked, const CameraModel& camera) {
  if (tracked.width_px != camera.width_px || tracked.height_px != camera.height_px)
    throw Error(path + ": is the track of pictures of " + size_text(tracked) + ", and the footage is " + size_text(camera) +
                "; give the track of this clip, or track it anew");
  const double distance = distance_px(tracked, camera);
  if (distance > kMaxDistance_px)
    throw Error(path + ": was tracked with another camera, whose picture lies up to " + fixed_text(distance, 1) +
                " px elsewhere (focal length " + fixed_text(tracked.fx_px, 1) + " px, here " + fixed_text(camera.fx_px, 1) +
                " px); give that --camera or --fov, or track anew");
}

void check_tag(const std::string& path, const PrintedTag& tracked, const PrintedTag& tag) {
  if (tracked == tag) return;
  throw Error(path + ": is the track of " + tag_text(tracked) + ", and the scene's tag is " + tag_text(tag) +
              "; give the track of this tag, or track it anew");
}

}  // namespace

double distance_px(const CameraModel& one, const CameraModel& other) {
  constexpr int kSteps = 8;
  double greatest = 0;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j) {
      const glm::dvec2 px(i * (one.width_px - 1.0) / kSteps, j * (one.height_px - 1.0) / kSteps);
      const auto ideal = undistort_px(one, px);
      if (!ideal) continue;
      const glm::dvec3 ray((ideal->x - one.cx_px) / one.fx_px, (ideal->y - one.cy_px) / one.fy_px, 1);
      const auto seen = project_px(other, ray);
      greatest = std::max(greatest, seen ? glm::distance(px, *seen) : std::numeric_limits<double>::infinity());
    }
  return greatest;
}

TrackCheck::TrackCheck(std::string path, const tracking::TrackFile& file, const CameraModel& camera, const PrintedTag& tag,
                       const SourceInfo& footage, WarningHandler warn)
    : path_(std::move(path)), has_times_(file.has_times), warn_(std::move(warn)) {
  if (footage.frame_rate > 0) half_interval_s_ = 0.5 / footage.frame_rate;
  for (const TrackRow& row : file.rows) times_s_.emplace(row.frame, row.time_s);
  if (file.subject) {
    check_camera(path_, file.subject->camera, camera);
    check_tag(path_, file.subject->tag, tag);
  }
  if (file.rows.empty() || !footage.frame_count || *footage.frame_count == 0) return;
  const std::int64_t first = footage.first_number, last = first + *footage.frame_count - 1;
  if (file.rows.front().frame < first || file.rows.back().frame > last)
    warn_(path_ + ": has rows of the frames " + std::to_string(file.rows.front().frame) + " to " +
          std::to_string(file.rows.back().frame) + ", and the footage has " + std::to_string(first) + " to " +
          std::to_string(last) + "; is it the track of another clip?");
}

void TrackCheck::see(std::int64_t frame, double time_s) {
  const auto row = times_s_.find(frame);
  if (row == times_s_.end()) {
    if (missing_++ == 0) first_missing_ = frame;
    return;
  }
  if (!has_times_ || half_interval_s_ == 0 || std::abs(row->second - time_s) < half_interval_s_) return;
  has_times_ = false;  // once is enough
  warn_(path_ + ": frame " + std::to_string(frame) + " is at " + fixed_text(row->second, 3) + " s in it, and at " +
        fixed_text(time_s, 3) + " s in the footage; is it the track of another clip?");
}

std::string TrackCheck::missing_rows() const {
  if (missing_ == 0) return "";
  return "; " + path_ + " has no row for " + std::to_string(missing_) + " of them, the first of which is frame " +
         std::to_string(first_missing_);
}

}  // namespace catchlight::app
