#include "app/track_export/track_export.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>

#include "app/support/output_file.hpp"
#include "app/track_export/camera_trajectory.hpp"
#include "app/track_export/formats.hpp"
#include "catchlight/util/text.hpp"
#include "tracking/track_file.hpp"

namespace catchlight::app {
namespace {

using Rows = std::vector<TrackRow>;

constexpr const char* kStdout = "-";

struct Format {
  std::string (*text)(const Rows& rows, const Shot& shot);
  bool holds_lost_frames = false;
  bool is_pinhole = false;           ///< all that it knows of the camera is the field of view
  bool is_lines = false;             ///< the text of several rows is the header and a line for each
  bool is_fitted_to_height = false;  ///< Blender's importer makes it a camera of vertical Sensor Fit
};

const std::map<std::string, Format>& formats() {
  static const std::map<std::string, Format> table{
      {".csv",
       {[](const Rows& rows, const Shot& shot) {
          return tracking::track_file_text(rows, tracking::TrackSubject{shot.camera, shot.scene.tag.target()});
        },
        true, false, true}},
      {".jsonl", {[](const Rows& rows, const Shot&) { return json_lines_text(rows); }, true, false, true}},
      {".tum", {[](const Rows& rows, const Shot&) { return tum_text(rows); }, false, false, true}},
      {".txt", {[](const Rows& rows, const Shot&) { return tum_text(rows); }, false, false, true}},
      {".chan", {chan_text, false, true}},
      {".gltf", {gltf_text, false, true, false, true}},
      {".glb", {glb_bytes, false, true, false, true}}};
  return table;
}

const Format& format_of(const std::string& path) {
  const std::string extension = path == kStdout ? ".csv" : std::filesystem::path(path).extension().string();
  if (const auto found = formats().find(extension); found != formats().end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [name, format] : formats()) known.push_back(name);
  throw UsageError(path + ": \"" + extension + "\" is no format of a track; expected " + quoted_list(known));
}

bool has_pose(const Rows& rows) {
  return std::any_of(rows.begin(), rows.end(), [](const TrackRow& row) { return row.found; });
}

constexpr double kBlenderSensorWidth_mm = 32;  ///< its .chan importer's default; the height beside it, 18, fits 16:9 alone

std::string shift_text(double share) {
  return fixed_text(share + 0.0, 4);
}

/// What a field of view does not say of the camera, and Blender's numbers for it; empty where that is nothing, or less than half
/// a pixel. `fit_px`: the side of the picture that Blender's Sensor Fit names.
std::string beyond_pinhole(const CameraModel& camera, double fit_px) {
  const double x_px = camera.cx_px - (camera.width_px - 1) / 2.0, y_px = camera.cy_px - (camera.height_px - 1) / 2.0;
  std::string text = camera.has_distortion() ? "the lens distortion" : "";
  if (std::max(std::abs(x_px), std::abs(y_px)) > 0.5) {
    const auto away = [](double px, const char* positive, const char* negative) {
      return plain_text(std::abs(std::round(px * 100) / 100)) + " px " + (px < 0 ? negative : positive);
    };
    text += (text.empty() ? "" : " and ") + std::string("the principal point, which lies ") + away(x_px, "right of", "left of") +
            " and " + away(y_px, "below", "above") + " the middle (Blender: Shift X " + shift_text(-x_px / fit_px) +
            ", Shift Y " + shift_text(y_px / fit_px) + ")";
  }
  return text;
}

}  // namespace

void check_track_format(const std::string& path) {
  format_of(path);
}

void write_track(const std::string& path, const std::vector<TrackRow>& rows, const Shot& shot, bool overwrite,
                 const WarningHandler& warn) {
  const Format& format = format_of(path);
  if (!format.holds_lost_frames && !has_pose(rows))
    throw Error(path + ": no frame has a pose, so there is no camera trajectory to write; .csv and .jsonl hold lost frames too");
  if (path == kStdout)
    std::cout << format.text(rows, shot) << std::flush;
  else
    write_text_file(path, format.text(rows, shot), overwrite);
  const double fit_px = format.is_fitted_to_height ? shot.camera.height_px : shot.camera.width_px;
  if (const std::string missing = beyond_pinhole(shot.camera, fit_px); format.is_pinhole && !missing.empty())
    warn(path + " does not hold " + missing + "; docs/track-formats.md says what to do about it");
}

std::string importer_settings(const std::string& path, const CameraModel& camera) {
  if (&format_of(path) != &formats().at(".chan")) return "";
  const double height_mm = kBlenderSensorWidth_mm * camera.height_px / camera.width_px;
  const std::string fov_deg = fixed_text(glm::degrees(vertical_fov_rad(camera)), 2);
  return path + ": choose rotation order ZXY where you import it; in Blender type Camera sensor width " +
         number_text(kBlenderSensorWidth_mm) + ", Camera sensor height " + number_text(std::round(height_mm * 1e4) / 1e4) +
         " (the vertical field of view is " + fov_deg + " degrees)";
}

bool is_track_of_lines(const std::string& path) {
  return format_of(path).is_lines;
}

TrackLines::TrackLines(const std::string& path, const Shot& shot, bool overwrite)
    : path_(path), shot_(shot), stream_(path == kStdout ? std::cout : file_) {
  const std::string header = format_of(path).text({}, shot);
  header_bytes_ = header.size();
  if (path != kStdout) {
    check_output_path(path, overwrite);
    file_.open(path, std::ios::binary);
  }
  put(header);
}

void TrackLines::write(const TrackRow& row) {
  put(format_of(path_).text({row}, shot_).substr(header_bytes_));
}

void TrackLines::put(const std::string& text) {
  stream_ << text << std::flush;
  if (!stream_) throw Error((path_ == kStdout ? "stdout" : path_) + ": cannot be written; is the disk full, or the reader gone?");
}

}  // namespace catchlight::app
