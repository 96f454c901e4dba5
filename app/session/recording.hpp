// A recording: footage, the camera that took it and the scene to put into it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/media/read/source.hpp"
#include "app/settings/scene_settings.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"

namespace catchlight::app {

/// What the command line says about a recording; it overrides what the files say.
struct RecordingOverrides {
  std::optional<std::string> scene_file, camera_file;
  std::optional<double> fov_deg;  ///< horizontal, instead of a camera file
  std::optional<double> fps;      ///< of an image sequence
  bool strict = false;            ///< refuse a probe with bad texels
  Renderer renderer = Renderer::automatic;
  std::string shader_folder;                                    ///< replaces the embedded shaders, where not empty
  std::vector<std::pair<std::string, std::string>> parameters;  ///< key and text, in the order given
};

struct Recording {
  std::string name;     ///< name of the folder, or of bare footage
  std::string folder;   ///< empty for bare footage
  std::string footage;  ///< what MediaSource::open takes
  std::optional<std::string> scene_file, camera_file;
  std::optional<double> fov_deg;  ///< where there is no camera file
  std::optional<double> fps;      ///< of an image sequence, where the user says it
  SceneSettings scene;
  std::vector<std::string> warnings;  ///< what of the folder is not used though it could be meant
  std::optional<std::string> poses_csv, truth_folder, mask_folder, expected_toml;  ///< where the folder has them
};

/// Opens what is at `location`: a folder with `video.{mp4,mkv,mov,avi}` or `plate/%04d.{png,jpg,exr}`, camera.yaml
/// (or .yml, .json, .xml) and scene.toml; or bare footage with the scene (or parameters that say what it would) and the camera
/// (or field of view) among the overrides. The footage itself is not opened. Throws Error that says what is missing and how to
/// supply it, and UsageError for overrides that cannot be.
Recording open_recording(const std::string& location, const RecordingOverrides& overrides = {});

/// All files that it is read from and that it names, for outputs to leave alone.
std::vector<std::string> files_of(const Recording& recording);

/// The footage, read with the camera's response where the scene names one. Throws Error as MediaSource::open and load_response
/// do.
std::unique_ptr<MediaSource> open_footage(const Recording& recording, const WarningHandler& warn = {}, SourceHooks hooks = {});

/// The camera of a recording whose footage turned out to be of this size: as tracking::read_camera_file_for() where there is a
/// camera file.
CameraModel camera_for_footage(const Recording& recording, int width_px, int height_px, const WarningHandler& warn = {});

}  // namespace catchlight::app
