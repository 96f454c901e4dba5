#include <CLI/CLI.hpp>
#include <memory>

#include "app/commands/commands.hpp"
#include "app/commands/finish_report.hpp"
#include "app/commands/help.hpp"
#include "app/session/session.hpp"
#include "app/support/output_file.hpp"
#include "app/track_export/track_export.hpp"
#include "catchlight/camera.hpp"

namespace catchlight::app {

namespace {

struct Options {
  std::string recording, output, track_in, report, frames;
  RecordingOverrides overrides;
  bool overwrite = false, causal = false, allow_lost = false;
};

void track(const Options& options, Context& context) {
  const FrameRange range = parse_frame_range(options.frames);
  check_track_format(options.output);
  if (options.output != "-") check_output_path(options.output, options.overwrite);
  if (!options.report.empty()) check_output_path(options.report, options.overwrite);
  Recording recording = open_recording(options.recording, options.overrides);
  std::vector<std::string> inputs = files_of(recording);
  inputs.push_back(options.track_in);
  refuse_shared_files({options.output, options.report}, inputs);
  Session session(std::move(recording),
                  {.task = "track",
                   .range = range,
                   .track_file = options.track_in,
                   .is_causal = options.causal,
                   .allows_lost = options.allow_lost},
                  context.log);
  const Shot shot{session.camera(), session.settings(), session.footage().info().is_sequence};
  if (is_one_pass(options.recording) && is_track_of_lines(options.output)) {
    TrackLines lines(options.output, shot, options.overwrite);
    session.track_range([&](const TrackRow& row) { lines.write(row); });
  } else {
    write_track(options.output, session.track_range(), shot, options.overwrite, context.log.warning_handler());
  }
  if (const std::string settings = importer_settings(options.output, session.camera()); !settings.empty())
    context.log.info(settings);
  finish_report(session, options.report, options.overwrite, context);
}

/// The tag, how its light is read, and what the track formats tell of the scene.
bool uses_parameter(const std::string& key) {
  return key.starts_with("tag.") || key.starts_with("object.") || key == "probe.up" || key == "exposure.mode" ||
         key == "exposure.response";
}

}  // namespace

void set_up_track(CLI::App& command, Context& context) {
  const auto options = std::make_shared<Options>();
  add_recording_options(command, context, options->recording, options->overrides, uses_parameter);
  command
      .add_option(
          "-o,--output", options->output,
          "track.csv (what --track reads), .jsonl; of the camera alone .tum or .txt (TUM RGB-D), .chan (Nuke), .gltf, .glb; - "
          "(CSV on stdout)")
      ->required();
  command.add_flag("-y,--overwrite", options->overwrite, "replace existing outputs");
  command.add_option("--frames", options->frames,
                     "only frames A:B, numbered from 0 (image sequences: by their own numbers), B left out");
  command.add_option("--track", options->track_in, "write this track file in another format, instead of tracking")
      ->type_name("FILE");
  command.add_flag("--causal", options->causal, "track as live footage is: each frame knows only those before it");
  command.add_flag("--allow-lost", options->allow_lost, "succeed also where the tag is never found");
  command.add_option("--report", options->report, "write what was done and how long it took, JSON");
  show_examples(command, {"catchlight track recordings/matte -o track.csv",
                          "catchlight track clip.mp4 --fov 60 --tag.id 12 --tag.size_m 0.14 -o camera.chan"});
  command.callback([options, &context] { track(*options, context); });
}

}  // namespace catchlight::app
