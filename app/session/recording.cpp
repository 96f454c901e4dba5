#include "app/session/recording.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "app/response/response_file.hpp"
#include "app/settings/look.hpp"
#include "app/settings/parameters.hpp"
#include "app/settings/scene_file.hpp"
#include "render/gl/shader_text.hpp"
#include "tracking/camera/camera_file.hpp"

namespace catchlight::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVideoNames[] = {"video.mp4", "video.mkv", "video.mov", "video.avi"};
constexpr const char* kCameraNames[] = {"camera.yaml", "camera.yml", "camera.json", "camera.xml"};
constexpr const char* kPlateExtensions[] = {".png", ".jpg", ".exr"};

/// A folder of stills counts where it holds at least one numbered file of the kind.
bool holds_numbered_stills(const fs::path& folder, const std::string& extension) {
  if (!fs::is_directory(folder)) return false;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string stem = entry.path().stem().string();
    if (entry.path().extension() == extension && !stem.empty() && stem.find_first_not_of("0123456789") == std::string::npos)
      return true;
  }
  return false;
}

/// Every footage that the folder holds; the first is the recording's.
std::vector<std::string> footage_in(const fs::path& folder) {
  std::vector<std::string> found;
  for (const char* name : kVideoNames)
    if (fs::exists(folder / name)) found.push_back((folder / name).string());
  for (const char* extension : kPlateExtensions)
    if (holds_numbered_stills(folder / "plate", extension))
      found.push_back((folder / "plate" / ("%04d" + std::string(extension))).string());
  if (found.empty())
    throw Error(folder.string() +
                ": no footage in this folder; expected video.mp4 (or .mkv, .mov, .avi) or plate/0000.png, ... (or .jpg, .exr)");
  return found;
}

std::optional<std::string> if_exists(const fs::path& path) {
  if (!fs::exists(path)) return std::nullopt;
  return path.string();
}

std::optional<std::string> find_camera(const fs::path& folder) {
  for (const char* name : kCameraNames)
    if (auto file = if_exists(folder / name)) return file;
  return std::nullopt;
}

/// "clip" for "/a/clip.mp4", "plate" for "/a/plate/%04d.png".
std::string name_of_footage(const std::string& location) {
  const fs::path path(location);
  return names_sequence(location) ? path.parent_path().filename().string() : path.stem().string();
}

Recording open_folder(const std::string& location) {
  const fs::path folder(location);
  Recording recording;
  recording.name = fs::canonical(folder).filename().string();
  recording.folder = location;
  const std::vector<std::string> footage = footage_in(folder);
  recording.footage = footage.front();
  if (footage.size() > 1)
    recording.warnings.push_back("the footage is " + footage[0] + ", not " + footage[1] +
                                 "; to take that, name it instead of the folder, with --scene and --camera");
  recording.camera_file = find_camera(folder);
  recording.poses_csv = if_exists(folder / "poses.csv");
  recording.truth_folder = if_exists(folder / "truth");
  recording.mask_folder = if_exists(folder / "mask");
  recording.expected_toml = if_exists(folder / "expected.toml");
  return recording;
}

Recording open_bare_footage(const std::string& location) {
  const bool is_plain_path = !is_one_pass(location) && !names_sequence(location);
  if (is_plain_path && !fs::exists(location))
    throw Error(location +
                ": no such file or folder; expected a recording's folder, a video, a %04d pattern, a camera, a stream's address "
                "or - for stdin");
  Recording recording;
  recording.name = name_of_footage(location);
  recording.footage = location;
  return recording;
}

/// A tag that is named twice, or two in one place, would give poses that are wrong and look certain.
void check_board(const SceneSettings::Tag& tag) {
  std::set<std::pair<std::string, int>> names{{tag.family, tag.id}};
  for (const SceneSettings::Tag::Bundled& further : tag.bundle) {
    const std::string family = further.family == "same" ? tag.family : further.family;
    const std::string what = family + " #" + std::to_string(further.id);
    if (!names.insert({family, further.id}).second)
      throw Error("tag.bundle names " + what + " twice; each further tag of a board has a number of its own");
    if (further.translation_m == glm::dvec3(0))
      throw Error("tag.bundle: " + what + " would lie where the tag itself does; give its place, " +
                  "tag.bundle.tag_from_this.translation_m");
  }
}

/// What supplies a missing piece, by the kind of recording.
std::string where_expected(const Recording& recording, const char* file) {
  return recording.folder.empty() ? "bare footage brings none" : "expected " + (fs::path(recording.folder) / file).string();
}

void choose_camera(Recording& recording, const RecordingOverrides& overrides) {
  if (overrides.camera_file && overrides.fov_deg) throw UsageError("--camera and --fov exclude each other; give one of them");
  if (overrides.fov_deg && !(*overrides.fov_deg > 0 && *overrides.fov_deg < 180))
    throw UsageError("--fov: expected a horizontal field of view between 0 and 180 degrees");
  if (overrides.camera_file) recording.camera_file = overrides.camera_file;
  if (overrides.fov_deg) {
    recording.fov_deg = overrides.fov_deg;
    if (recording.camera_file)
      recording.warnings.push_back("--fov overrides " + *recording.camera_file + ": its lens and distortion are not used");
    recording.camera_file.reset();
  }
  if (!recording.camera_file && !recording.fov_deg)
    throw Error(recording.footage + ": no camera (" + where_expected(recording, "camera.yaml") +
                "); pass --camera FILE, or --fov DEGREES where it is not calibrated");
}

/// Options can say all that a scene file would. The tag's number and size have to be among them: a default would be a guess at
/// the print in the footage, and at how large everything is.
bool describe_tag(const RecordingOverrides& overrides) {
  const auto gives = [&](const std::string& key) {
    return std::ranges::any_of(overrides.parameters, [&](const auto& parameter) { return parameter.first == key; });
  };
  return gives("tag.id") && gives("tag.size_m");
}

void choose_scene(Recording& recording, const RecordingOverrides& overrides) {
  recording.scene_file = overrides.scene_file;
  if (!recording.scene_file && !recording.folder.empty())
    recording.scene_file = if_exists(fs::path(recording.folder) / "scene.toml");
  if (!recording.scene_file && !describe_tag(overrides))
    throw Error(recording.footage + ": no scene (" + where_expected(recording, "scene.toml") +
                "); pass --scene FILE, or say it by options, --tag.id NUMBER and --tag.size_m METRES at least");
  if (recording.scene_file) recording.scene = read_scene_file(*recording.scene_file);
  std::set<std::string> options;
  for (const auto& [key, text] : overrides.parameters) {
    set_parameter_from_text(recording.scene, key, text);
    options.insert(key);
  }
  // A look that is an option overrides what the scene file sets, as options do.
  apply_look(recording.scene, options.contains("look") ? options : recording.scene.by_hand);
  recording.scene.probe.strict = overrides.strict;
  if (!overrides.shader_folder.empty()) {
    if (overrides.renderer == Renderer::cpu)
      throw Error("--shader-dir has shaders for OpenGL, and --renderer cpu uses none; leave one of them out");
    render::check_shader_folder(overrides.shader_folder);
  }
  recording.scene.shader_folder = overrides.shader_folder;
  recording.scene.renderer = overrides.renderer;
}

}  // namespace

Recording open_recording(const std::string& location, const RecordingOverrides& overrides) {
  Recording recording = fs::is_directory(location) ? open_folder(location) : open_bare_footage(location);
  recording.fps = overrides.fps;
  choose_camera(recording, overrides);
  choose_scene(recording, overrides);
  check_board(recording.scene.tag);
  return recording;
}

std::vector<std::string> files_of(const Recording& recording) {
  const SceneSettings& scene = recording.scene;
  std::vector<std::string> files{recording.footage};
  for (const auto& file : {recording.scene_file, recording.camera_file, recording.poses_csv, recording.expected_toml})
    if (file) files.push_back(*file);
  for (const SceneSettings::Object& object : scene.objects) files.push_back(scene.resolve(object.mesh));
  for (const char* key : {"probe.image", "exposure.response", "glare.aperture"}) files.push_back(word_or_path(scene, key));
  return files;
}

std::unique_ptr<MediaSource> open_footage(const Recording& recording, const WarningHandler& warn, SourceHooks hooks) {
  const auto known = [&]() -> std::shared_ptr<const CameraResponse> {
    const auto response = load_response(word_or_path(recording.scene, "exposure.response"), warn);
    return response ? std::make_shared<CameraResponse>(*response) : nullptr;
  };
  return MediaSource::open(recording.footage, recording.fps, known(), std::move(hooks));
}

CameraModel camera_for_footage(const Recording& recording, int width_px, int height_px, const WarningHandler& warn) {
  if (!recording.camera_file) return tracking::camera_from_field_of_view(width_px, height_px, recording.fov_deg.value());
  return tracking::read_camera_file_for(*recording.camera_file, recording.footage, width_px, height_px, warn);
}

}  // namespace catchlight::app
