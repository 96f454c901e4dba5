#include "app/media/read/source.hpp"

#include <unistd.h>

#include <filesystem>

extern "C" {
#include <libavdevice/avdevice.h>
}

#include "app/media/late_library.hpp"
#include "app/media/read/newest_frame_source.hpp"
#include "app/media/read/sequence.hpp"
#include "app/media/read/video_source.hpp"
#include "catchlight/error.hpp"

namespace catchlight::app {
namespace {

namespace fs = std::filesystem;

bool is_address(const std::string& location) {
  return location.find("://") != std::string::npos;
}

constexpr std::string_view kCameraName = "camera:";

bool is_camera(const std::string& location) {
  return location.starts_with("/dev/video") || location.starts_with(kCameraName);
}

/// "/dev/video0" for "camera:0".
std::string device_of(const std::string& camera) {
  if (!camera.starts_with(kCameraName)) return camera;
  const std::string number = camera.substr(kCameraName.size());
  if (number.empty() || number.find_first_not_of("0123456789") != std::string::npos)
    throw UsageError("'" + camera + "': expected the camera's number, as in camera:0 for /dev/video0");
  return "/dev/video" + number;
}

constexpr double kUsualSequenceFps = 24;
constexpr int kMaxRateTerm = 1001000;  // of 30000/1001 and its like

std::pair<std::string, std::string> frame_rate_option(AVRational rate) {
  return {"framerate", std::to_string(rate.num) + "/" + std::to_string(rate.den)};
}

SourceRequest sequence_request(const std::string& location, const SequencePattern& pattern, std::optional<double> fps) {
  const std::vector<std::int64_t> numbers = pattern.existing();
  if (numbers.empty()) throw Error("no file matches '" + location + "' (the first could be '" + pattern.file(1).string() + "')");
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    const std::int64_t wanted = numbers[i - 1] + 1;
    if (numbers[i] == wanted) continue;
    throw Error("'" + location + "' has a gap: number " + std::to_string(wanted) + " ('" + pattern.file(wanted).string() +
                "') is missing between " + std::to_string(numbers.front()) + " and " + std::to_string(numbers.back()));
  }
  if (fps && !(*fps > 0)) throw UsageError("--fps: the frame rate of '" + location + "' must be above 0");
  SourceRequest request{location, "file:" + pattern.printf_path(), "image2", {}, {}, {}, {}};
  request.options = {{"pattern_type", "sequence"}, {"start_number", std::to_string(numbers.front())}};
  request.options.push_back(frame_rate_option(av_d2q(fps.value_or(kUsualSequenceFps), kMaxRateTerm)));
  request.info.is_sequence = true;
  request.info.first_number = numbers.front();
  request.info.frame_count = static_cast<std::int64_t>(numbers.size());
  return request;
}

SourceRequest file_request(const std::string& location) {
  if (!fs::exists(location)) throw Error("no such file: '" + location + "'");
  if (fs::is_directory(location)) {
    throw Error("'" + location + "' is a folder; name a video in it, or its pictures as in '" + location + "/%04d.png'");
  }
  // With the protocol named, a colon in a file's name stays part of the name.
  return {location, "file:" + location, "", {}, {}, {}, {}};
}

SourceRequest stdin_request() {
  if (isatty(STDIN_FILENO) != 0)
    throw UsageError("'-' is stdin, and nothing is piped into it; as in `ffmpeg -i clip.mp4 -f yuv4mpegpipe - | catchlight ...`");
  return {"stdin", "pipe:0", "", {}, {}, {}, {}};
}

SourceRequest live_request(const std::string& location, const std::string& url, const std::string& input_format) {
  SourceRequest request{location, url, input_format, {}, {}, {}, {}};
  request.info.is_live = true;
  return request;
}

SourceRequest camera_request(const std::string& location) {
  static const LateLibrary devices("libavdevice.so." AV_STRINGIFY(LIBAVDEVICE_VERSION_MAJOR));
  devices.function<decltype(&avdevice_register_all)>("avdevice_register_all")();
  return live_request(location, device_of(location), "v4l2");
}

SourceRequest request_of(const std::string& location, std::optional<double> sequence_fps) {
  if (location == "-") return stdin_request();
  if (is_address(location)) return live_request(location, location, "");
  if (is_camera(location)) return camera_request(location);
  return names_sequence(location) ? sequence_request(location, *SequencePattern::parse(location), sequence_fps)
                                  : file_request(location);
}

}  // namespace

bool names_sequence(const std::string& location) {
  return SequencePattern::parse(location) && !fs::exists(location);
}

bool is_one_pass(const std::string& location) {
  return location == "-" || is_address(location) || is_camera(location);
}

std::unique_ptr<MediaSource> MediaSource::open(const std::string& location, std::optional<double> sequence_fps,
                                               std::shared_ptr<const CameraResponse> response, SourceHooks hooks) {
  capture_ffmpeg_log();
  if (location.empty())
    throw UsageError("no footage named: a file, a pattern such as 'plate/%04d.png', a camera or an address is wanted");
  SourceRequest request = request_of(location, sequence_fps);
  request.response = std::move(response);
  request.hooks = std::move(hooks);
  request.info.is_one_pass = is_one_pass(location);
  const bool is_sequence = request.info.is_sequence;
  if (sequence_fps && !is_sequence) throw UsageError("--fps is for image sequences; '" + location + "' says its own frame rate");
  auto source = std::make_unique<VideoSource>(request);
  if (const AVRational declared = source->declared_rate(); is_sequence && !sequence_fps && declared.num > 0) {
    request.options.back() = frame_rate_option(declared);
    source = std::make_unique<VideoSource>(std::move(request));
  }
  if (!source->info().is_live) return source;
  return std::make_unique<NewestFrameSource>(std::move(source));
}

}  // namespace catchlight::app
