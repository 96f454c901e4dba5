#include <CLI/CLI.hpp>
#include <memory>

#include "app/commands/commands.hpp"
#include "app/session/overlay.hpp"
#include "app/support/output_file.hpp"
#include "app/track_export/track_export.hpp"
#include "catchlight/camera.hpp"
#include "tracking/track_file.hpp"

namespace catchlight::app {

namespace {

struct Options {
  std::string recording, output, track_in, report, frames;
  RecordingOverrides overrides;
  bool overwrite = false, causal = false;
};

OverlayResult tracked(const Options& options, const Recording& recording, const CameraModel& camera, MediaSource& source,
                      const FrameRange& range, Context& context, Report& report) {
  if (!options.track_in.empty()) {
    const auto known = make_recorded_track(tracking::read_track_file(options.track_in), camera, recording.scene);
    return run_track(source, *known, range, context.log, report);
  }
  if (options.causal || source.info().is_live)
    return run_track(source, *make_tag_track(camera, recording.scene), range, context.log, report);
  return solve_track(source, camera, recording.scene, range, context.log, report);
}

void track(const Options& options, Context& context) {
  const FrameRange range = parse_frame_range(options.frames);
  check_track_format(options.output);
  check_output_path(options.output, options.overwrite);
  if (!options.report.empty()) check_output_path(options.report, options.overwrite);
  const Recording recording = open_recording(options.recording, options.overrides);
  const std::unique_ptr<MediaSource> source = open_footage(recording, context.log.warning_handler());
  const CameraModel camera = camera_for_footage(recording, source->info().width_px, source->info().height_px);

  Report report;
  const OverlayResult result = tracked(options, recording, camera, *source, range, context, report);
  warn_of_lost_frames(report, context.log);
  write_track(options.output, result.rows, {camera, recording.scene, source->info().is_sequence}, options.overwrite,
              context.log.warning_handler());
  report.warnings = context.log.warnings();
  if (!options.report.empty()) write_report(options.report, report, options.overwrite);
  context.log.info(report_summary(report));
  if (result.damage) {
    context.log.error(*result.damage);
    context.exit_code = 1;
  }
}

}  // namespace

void set_up_track(CLI::App& command, Context& context) {
  const auto options = std::make_shared<Options>();
  add_recording_options(command, context, options->recording, options->overrides);
  command
      .add_option(
          "-o,--output", options->output,
          "track.csv (what --track reads), .jsonl; of the camera alone .tum or .txt (TUM RGB-D), .chan (Nuke), .gltf, .glb")
      ->required();
  command.add_flag("-y,--overwrite", options->overwrite, "replace existing outputs");
  command.add_option("--frames", options->frames,
                     "only frames A:B, numbered from 0 (image sequences: by their own numbers), B left out");
  command.add_option("--track", options->track_in, "write this track file in another format, instead of tracking")
      ->type_name("FILE");
  command.add_flag("--causal", options->causal, "track as live footage is: each frame knows only those before it");
  command.add_option("--report", options->report, "write what was done and how long it took, JSON");
  command.callback([options, &context] { track(*options, context); });
}

}  // namespace catchlight::app
