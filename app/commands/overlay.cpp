#include <CLI/CLI.hpp>
#include <memory>

#include "app/commands/commands.hpp"
#include "app/commands/finish_report.hpp"
#include "app/commands/help.hpp"
#include "app/media/write/frame_output.hpp"
#include "app/session/debug_drawing.hpp"
#include "app/session/run_stages.hpp"
#include "app/support/output_file.hpp"
#include "app/track_export/track_export.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/util/enum_names.hpp"
#include "render/probe/probe.hpp"

namespace catchlight::app {

namespace {

struct Options {
  std::string recording, output, track_in, track_out, report, frames;
  RecordingOverrides overrides;
  SinkOptions sink;
  LayerStyle style = LayerStyle::plain;
  bool causal = false, debug = false, allow_lost = false;
};

/// What can be refused before the footage is opened.
void check(const Options& options) {
  if (options.debug && holds_layers(options.output))
    throw UsageError("--debug draws on pictures, and " + options.output +
                     " is layers; choose a video or %04d.png, or leave --debug out");
  if (!options.track_out.empty()) {
    check_track_format(options.track_out);
    if (options.track_out == "-" && options.output == "-")
      throw UsageError("-o - and --track-out -: both would go to stdout; give one of them a file");
    if (options.track_out != "-") check_output_path(options.track_out, options.sink.overwrite);
  }
  if (!options.report.empty()) check_output_path(options.report, options.sink.overwrite);
}

LayerOptions layer_options(const Session& session, LayerStyle style) {
  const glm::dmat3 tag_from_world = render::tag_from_probe(session.settings().probe.up, 0);
  return {style, session.camera(), glm::transpose(tag_from_world), "Catchlight " CATCHLIGHT_VERSION};
}

void draw_frames(Session& session, FrameOutput& output, TrackLines* lines, bool draws_debug) {
  run_stages(session, [&](FrameJob& job) {
    if (lines != nullptr) lines->write(job.track);
    if (draws_debug) draw_debug(job.image, job.track, session.camera(), session.settings().tag.size_m, job.result);
    const std::optional<RigidTransform> pose = job.track.found ? std::optional(job.track.camera_from_tag) : std::nullopt;
    session.measure("encode", [&] { output.write(job.image, job.result, pose); });
  });
  output.finish();
}

void overlay(const Options& options, Context& context) {
  const FrameRange range = parse_frame_range(options.frames);
  check(options);
  Recording recording = open_recording(options.recording, options.overrides);
  std::vector<std::string> inputs = files_of(recording);
  inputs.push_back(options.track_in);
  refuse_shared_files({options.output, options.track_out, options.report}, inputs);
  const bool has_track = !options.track_out.empty();
  const bool has_lines = has_track && is_one_pass(options.recording) && is_track_of_lines(options.track_out);
  Session session(std::move(recording),
                  {.range = range,
                   .track_file = options.track_in,
                   .is_causal = options.causal,
                   .wants_layers = holds_layers(options.output),
                   .wants_frames = !options.debug,
                   .allows_lost = options.allow_lost,
                   .keeps_track = has_track && !has_lines},
                  context.log);
  SinkOptions sink = options.sink;
  sink.frames = range;
  const std::unique_ptr<FrameOutput> output =
      open_output(options.output, session.recording().footage, session.footage(), sink, layer_options(session, options.style));
  const Shot shot{session.camera(), session.settings(), session.footage().info().is_sequence};
  std::optional<TrackLines> lines;
  if (has_lines) lines.emplace(options.track_out, shot, options.sink.overwrite);
  draw_frames(session, *output, lines ? &*lines : nullptr, options.debug);

  if (has_track && !has_lines) {
    write_track(options.track_out, session.track_rows(), shot, options.sink.overwrite, context.log.warning_handler());
    if (const std::string settings = importer_settings(options.track_out, session.camera()); !settings.empty())
      context.log.info(settings);
  }
  finish_report(session, options.report, options.sink.overwrite, context);
}

}  // namespace

void set_up_overlay(CLI::App& command, Context& context) {
  const auto options = std::make_shared<Options>();
  add_recording_options(command, context, options->recording, options->overrides);
  add_renderer_options(command, options->overrides);
  command
      .add_option("-o,--output", options->output,
                  "out.mp4, .mkv, .mov (H.264); .avi, .nut (FFV1); .y4m; %04d.png; %04d.exr (layers); - (y4m on stdout)")
      ->required();
  command.add_flag("-y,--overwrite", options->sink.overwrite, "replace existing outputs");
  command.add_option("--frames", options->frames,
                     "only frames A:B, numbered from 0 (image sequences: by their own numbers), B left out");
  command.add_option("--track", options->track_in, "poses from this track file instead of from the pictures");
  command.add_option("--track-out", options->track_out, "write the track, in any format of `catchlight track`");
  command.add_flag("--causal", options->causal, "track as live footage is: each frame knows only those before it");
  command.add_flag("--debug", options->debug, "draw the tag's corners, axes, state and residual over the frames");
  command.add_flag("--allow-lost", options->allow_lost, "succeed also where the tag is never found");
  command.add_option("--report", options->report, "write what was done and how long it took, JSON");
  command
      .add_option_function<std::string>(
          "--layers-for", [options](const std::string& name) { options->style = value_named<LayerStyle>(name).value(); },
          "Layers (.exr) for nuke or blender: normals in its axes, and motion vectors; docs/conventions.md says which")
      ->check(CLI::IsMember({"nuke", "blender"}));
  command.add_option("--codec", options->sink.codec, "h264 or ffv1, instead of what the extension says")
      ->check(CLI::IsMember({"h264", "ffv1"}));
  command
      .add_option("--pixel-format", options->sink.pixel_format,
                  "FFmpeg's name, such as yuv444p; else the footage's, and yuv420p where RGB becomes .mp4, .mov or y4m")
      ->type_name("NAME");
  command.add_option("--crf", options->sink.crf, "H.264 quality, 0 (lossless) to 51")
      ->check(CLI::Range(0, 51))
      ->capture_default_str();
  command.add_option("--preset", options->sink.preset, "H.264 speed, ultrafast to veryslow")->capture_default_str();
  show_examples(command, {"catchlight overlay recordings/matte -o out.mp4",
                          "catchlight overlay clip.mp4 --camera camera.yaml --scene scene.toml -o out.%04d.exr --frames 24:48"});
  command.callback([options, &context] { overlay(*options, context); });
}

}  // namespace catchlight::app
