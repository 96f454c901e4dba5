#include "app/window/playing/take_recorder.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "app/media/write/sink.hpp"
#include "app/settings/parameters.hpp"
#include "app/settings/scene_file.hpp"
#include "app/settings/scene_file_edit.hpp"
#include "app/support/output_file.hpp"
#include "app/tools/calibration/report.hpp"

namespace catchlight::app {
namespace {

namespace fs = std::filesystem;

/// Frames that wait to be written may take about so much memory.
constexpr std::int64_t kMaxWaiting_bytes = std::int64_t{256} << 20;

std::size_t max_waiting(const SourceInfo& footage) {
  constexpr std::int64_t kBytesPerPixel = 3, kMinFrames = 8;
  const std::int64_t frame = std::max(kBytesPerPixel * footage.width_px * footage.height_px, kBytesPerPixel);
  return static_cast<std::size_t>(std::max(kMaxWaiting_bytes / frame, kMinFrames));
}

/// The footage as a sink has to know it; its frames come from elsewhere.
class DescribedSource final : public MediaSource {
 public:
  explicit DescribedSource(SourceInfo info) : info_(std::move(info)) { info_.is_one_pass = true; }
  const SourceInfo& info() const override { return info_; }
  std::optional<Frame> read() override { return std::nullopt; }
  const AVStream* video_stream() const override { return nullptr; }

 private:
  SourceInfo info_;
};

/// Settings for a scene file elsewhere: what they name relative to their own is named as a whole.
SceneSettings moved_to(const std::string& folder, SceneSettings scene) {
  const SceneSettings before = scene;
  for (const Parameter& parameter : parameters()) {
    const auto* kind = std::get_if<PathKind>(&parameter.kind);
    for (std::size_t i = 0; kind && i < element_count(before, parameter); ++i) {
      const std::string name = parameter_text(before, parameter, i);
      if (!name.empty() && !kind->is_word(name)) kind->access(scene, i) = fs::absolute(before.resolve(name)).lexically_normal();
    }
  }
  scene.folder = folder;
  return scene;
}

}  // namespace

TakeRecorder::TakeRecorder(std::string folder, Recording live, SourceInfo footage)
    : folder_(std::move(folder)), live_(std::move(live)), footage_(std::move(footage)), waiting_(max_waiting(footage_)) {
  if (folder_.empty()) throw Error("no folder to record into; name one that does not exist yet");
  if (fs::exists(folder_)) throw Error(folder_ + " exists already; name another folder to record into");
  make_output_folder(folder_);
  thread_ = std::jthread([this] { run(); });
}

void TakeRecorder::add(const Frame& frame) {
  if (!is_stopped_ && !waiting_.offer(frame)) ++left_out_;
}

void TakeRecorder::stop() {
  is_stopped_ = true;
  waiting_.end();
}

TakeStatus TakeRecorder::status() const {
  const std::lock_guard lock(mutex_);
  return {folder_, written_, left_out_, is_over_, error_};
}

void TakeRecorder::write_camera() const {
  const fs::path folder(folder_);
  if (!live_.camera_file) {
    const CameraModel camera = camera_for_footage(live_, footage_.width_px, footage_.height_px);
    return write_text_file((folder / "camera.yaml").string(), camera_text(camera, "camera.yaml"), false);
  }
  const std::string extension = fs::path(*live_.camera_file).extension().string();
  const bool is_known = extension == ".json" || extension == ".xml";
  fs::copy_file(*live_.camera_file, folder / ("camera" + (is_known ? extension : ".yaml")));
}

void TakeRecorder::write_scene() const {
  const SceneSettings file = live_.scene_file ? read_scene_file(*live_.scene_file) : SceneSettings{};
  save_scene_file(live_.scene_file.value_or(""), (fs::path(folder_) / "scene.toml").string(), file,
                  moved_to(folder_, live_.scene));
}

void TakeRecorder::write_footage() {
  const std::string path = (fs::path(folder_) / "video.mkv").string();
  // Without loss, in the least time that x264 can: the frames come as fast as a camera sends them.
  const auto sink =
      MediaSink::open(path, live_.footage, DescribedSource(footage_), {.codec = "h264", .crf = 0, .preset = "ultrafast"});
  drain(waiting_, [&](const Frame& frame) {
    sink->write(frame);
    ++written_;
  });
  sink->finish();
}

void TakeRecorder::run() {
  std::optional<std::string> error;
  try {
    write_camera();
    write_scene();
    write_footage();
  } catch (const std::exception& failure) {
    error = failure.what();
    is_stopped_ = true;
    waiting_.close();
    std::error_code ignored;
    if (written_ == 0) fs::remove_all(folder_, ignored);
  }
  const std::lock_guard lock(mutex_);
  error_ = error;
  is_over_ = true;
}

}  // namespace catchlight::app
