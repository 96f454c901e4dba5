#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/commands/commands.hpp"
#include "app/session/overlay.hpp"
#include "app/session/reference_frame.hpp"
#include "app/support/output_file.hpp"
#include "app/support/progress.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "catchlight/track.hpp"
#include "catchlight/util/text.hpp"
#include "render/image/image_io.hpp"
#include "tracking/track_file.hpp"

namespace catchlight::app {
namespace {

struct Options {
  std::string recording, output, track_in;
  RecordingOverrides overrides;
  std::int64_t frame = 0;
  ReferenceQuality quality;
  bool overwrite = false;
};

struct TrackedFrame {
  Frame frame;
  TrackRow row;
};

std::string default_output(std::int64_t frame) {
  char name[64];
  std::snprintf(name, sizeof name, "reference.%04lld.png", static_cast<long long>(frame));
  return name;
}

void check_extension(const std::string& output) {
  const std::string extension = std::filesystem::path(output).extension().string();
  if (extension != ".png" && extension != ".exr")
    throw UsageError(output + ": expected a name that ends in .png (coded as the footage is) or .exr (exposed linear light)");
}

[[noreturn]] void refuse_frame(const std::string& footage, std::int64_t frame, std::int64_t first, std::int64_t read) {
  throw Error(footage + ": there is no frame " + std::to_string(frame) + "; it has " + std::to_string(read) + " from " +
              std::to_string(first) + ". Choose another --frame");
}

/// The frame with the pose that `overlay` would draw it at.
TrackedFrame tracked_frame(const Options& options, const Recording& recording, const CameraModel& camera, Log& log) {
  const auto source = open_footage(recording, log.warning_handler());
  if (source->info().is_live)
    throw UsageError(recording.footage + ": a reference needs recorded footage, not a camera or stream");
  std::vector<TrackRow> rows;
  if (!options.track_in.empty()) {
    rows = tracking::read_track_file(options.track_in);
  } else {
    Report report;
    rows = solve_track(*open_footage(recording), camera, recording.scene, {options.frame, options.frame + 1}, log, report).rows;
  }
  const auto track = make_recorded_track(std::move(rows), camera, recording.scene);
  const std::int64_t first = source->info().first_number;
  std::int64_t read = 0;
  for (; const std::optional<Frame> frame = source->read(); ++read) {
    const TrackRow row = track->row(*frame);
    if (frame->number() != options.frame) continue;
    if (!row.found)
      throw Error(recording.footage + ": the tag is not found in frame " + std::to_string(options.frame) +
                  "; choose another --frame, or give its pose by --track");
    return {*frame, row};
  }
  refuse_frame(recording.footage, options.frame, first, read);
}

void trace(const Options& options, Context& context) {
  const std::string output = options.output.empty() ? default_output(options.frame) : options.output;
  check_extension(output);
  check_output_path(output, options.overwrite);
  const Recording recording = open_recording(options.recording, options.overrides);
  const SourceInfo info = MediaSource::open(recording.footage)->info();
  const CameraModel camera = camera_for_footage(recording, info.width_px, info.height_px);
  const auto start = std::chrono::steady_clock::now();
  const TrackedFrame found = tracked_frame(options, recording, camera, context.log);
  const Image traced = trace_reference_frame(found.frame, found.row, camera, recording.scene, options.quality,
                                             context.log.warning_handler(), progress_handler(context.log, "reference"));
  if (std::filesystem::path(output).extension() == ".exr")
    render::write_exr(output, {{"", &traced, {"R", "G", "B"}}});
  else
    write_reference_png(output, traced, found.frame, options.overwrite);
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  context.log.info(output + ": frame " + std::to_string(options.frame) + ", " + std::to_string(options.quality.samples) +
                   " samples a pixel, " + std::to_string(options.quality.bounces) + " bounces, " + fixed_text(elapsed_s, 1) +
                   " s");
}

}  // namespace

void set_up_reference(CLI::App& command, Context& context) {
  const auto options = std::make_shared<Options>();
  add_recording_options(command, context, options->recording, options->overrides);
  command.add_option("--frame", options->frame, "the frame, numbered from 0 (image sequences: by its own number)")->required();
  command.add_option("-o,--output", options->output, "picture.png or .exr; left out: reference.NNNN.png")->type_name("FILE");
  command.add_flag("-y,--overwrite", options->overwrite, "replace an existing output");
  command.add_option("--track", options->track_in, "pose from this track file instead of from the pictures")->type_name("FILE");
  command.add_option("--samples", options->quality.samples, "light paths a pixel")
      ->check(CLI::Range(1, 1 << 20))
      ->capture_default_str();
  command.add_option("--bounces", options->quality.bounces, "reflections after the first")
      ->check(CLI::Range(0, 64))
      ->capture_default_str();
  command.callback([options, &context] { trace(*options, context); });
}

}  // namespace catchlight::app
