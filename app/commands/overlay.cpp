#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "app/commands/commands.hpp"
#include "app/session/overlay.hpp"
#include "app/settings/look.hpp"
#include "app/support/output_file.hpp"
#include "app/track_export/track_export.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "tracking/track_file.hpp"

namespace catchlight::app {

namespace {

struct Options {
  std::string recording, output, track_in, track_out, report, frames;
  RecordingOverrides overrides;
  SinkOptions sink;
  bool causal = false, debug = false;
};

/// Recorded footage is tracked as a whole before its first frame is drawn.
std::unique_ptr<FrameTrack> open_track(const Options& options, const Recording& recording, const CameraModel& camera,
                                       bool is_live, const FrameRange& range, Context& context, Report& report) {
  if (!options.track_in.empty()) return make_recorded_track(tracking::read_track_file(options.track_in), camera, recording.scene);
  if (options.causal || is_live) return make_tag_track(camera, recording.scene);
  // Adapting exposure needs the poses of all that comes before, too.
  const FrameRange posed = tone_settings(recording.scene).enabled ? FrameRange{.end = range.end} : range;
  Report tracking;
  const OverlayResult solved = solve_track(*open_footage(recording), camera, recording.scene, posed, context.log, tracking);
  report.stages = tracking.stages;
  return make_recorded_track(solved.rows, camera, recording.scene);
}

void overlay(const Options& options, Context& context) {
  const FrameRange range = parse_frame_range(options.frames);
  if (options.debug && std::filesystem::path(options.output).extension() == ".exr")
    throw UsageError("--debug draws on pictures, and " + options.output +
                     " is layers; choose a video or %04d.png, or leave --debug out");
  if (!options.track_out.empty()) {
    check_track_format(options.track_out);
    check_output_path(options.track_out, options.sink.overwrite);
  }
  if (!options.report.empty()) check_output_path(options.report, options.sink.overwrite);
  const Recording recording = open_recording(options.recording, options.overrides);
  const std::unique_ptr<MediaSource> source = open_footage(recording, context.log.warning_handler());
  const CameraModel camera = camera_for_footage(recording, source->info().width_px, source->info().height_px);
  SinkOptions sink = options.sink;
  sink.frames = range;
  const std::unique_ptr<FrameOutput> output = open_output(options.output, recording.footage, *source, sink);

  Report report;
  const std::unique_ptr<FrameTrack> track =
      open_track(options, recording, camera, source->info().is_live, range, context, report);
  Stage stage = build_stage(recording.scene, context.log, report);
  stage.draws_debug = options.debug;
  const OverlayResult result = run_overlay(*source, *track, stage, recording.scene, camera, *output, range, context.log, report);
  if (!options.track_out.empty())
    write_track(options.track_out, result.rows, {camera, recording.scene, source->info().is_sequence}, options.sink.overwrite,
                context.log.warning_handler());
  report.warnings = context.log.warnings();
  if (!options.report.empty()) write_report(options.report, report, options.sink.overwrite);
  context.log.info(report_summary(report));
  if (result.damage) {
    context.log.error(*result.damage);
    context.exit_code = 1;
  }
}

}  // namespace

void set_up_overlay(CLI::App& command, Context& context) {
  const auto options = std::make_shared<Options>();
  add_recording_options(command, context, options->recording, options->overrides);
  add_shader_option(command, options->overrides);
  command
      .add_option("-o,--output", options->output,
                  "out.mp4, .mkv, .mov (H.264); .avi, .nut (FFV1); %04d.png; %04d.exr (layers); - (y4m on stdout)")
      ->required();
  command.add_flag("-y,--overwrite", options->sink.overwrite, "replace existing outputs");
  command.add_option("--frames", options->frames,
                     "only frames A:B, numbered from 0 (image sequences: by their own numbers), B left out");
  command.add_option("--track", options->track_in, "poses from this track file instead of from the pictures");
  command.add_option("--track-out", options->track_out, "write the track, in any format of `catchlight track`");
  command.add_flag("--causal", options->causal, "track as live footage is: each frame knows only those before it");
  command.add_flag("--debug", options->debug, "draw the tag's corners, axes, state and residual over the frames");
  command.add_option("--report", options->report, "write what was done and how long it took, JSON");
  command.add_option("--codec", options->sink.codec, "h264 or ffv1, instead of what the extension says")
      ->check(CLI::IsMember({"h264", "ffv1"}));
  command.add_option("--crf", options->sink.crf, "H.264 quality, 0 (lossless) to 51")
      ->check(CLI::Range(0, 51))
      ->capture_default_str();
  command.add_option("--preset", options->sink.preset, "H.264 speed, ultrafast to veryslow")->capture_default_str();
  command.callback([options, &context] { overlay(*options, context); });
}

}  // namespace catchlight::app
