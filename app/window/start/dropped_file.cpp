#include "app/window/start/dropped_file.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <initializer_list>

namespace catchlight::app {
namespace {

namespace fs = std::filesystem;

/// What of the command line's is about the program, and not about a recording.
RecordingOverrides without_recording(const RecordingOverrides& given) {
  RecordingOverrides kept;
  kept.strict = given.strict, kept.renderer = given.renderer, kept.shader_folder = given.shader_folder;
  return kept;
}

}  // namespace

DroppedKind kind_of_dropped(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto is_one_of = [&](std::initializer_list<const char*> known) { return std::ranges::count(known, ending) > 0; };
  std::error_code missing;
  if (fs::is_directory(path, missing)) return DroppedKind::recording;
  if (ending == ".toml") return DroppedKind::scene;
  if (is_one_of({".exr", ".hdr", ".pic", ".jpg", ".jpeg", ".png", ".tif", ".tiff"})) return DroppedKind::probe;
  if (is_one_of({".glb", ".gltf", ".obj", ".ply"})) return DroppedKind::model;
  if (is_one_of({".mp4", ".mkv", ".mov", ".avi", ".nut", ".y4m", ".m4v", ".webm", ".mxf", ".mts", ".mpg"}))
    return DroppedKind::footage;
  return DroppedKind::other;
}

OpenedRecording opened_by_drop(const std::string& path, const RecordingOverrides& given, const std::optional<Recording>& now) {
  OpenedRecording opened{path, without_recording(given)};
  if (kind_of_dropped(path) == DroppedKind::scene) {
    opened.location = fs::absolute(path).parent_path().string();
    if (fs::path(path).filename() != "scene.toml") opened.overrides.scene_file = path;
  }
  if (kind_of_dropped(path) == DroppedKind::footage) {
    opened.overrides = given;
    if (now && !given.scene_file) opened.overrides.scene_file = now->scene_file;
    if (now && !given.camera_file && !given.fov_deg) opened.overrides.camera_file = now->camera_file;
  }
  return opened;
}

}  // namespace catchlight::app
