#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/commands/commands.hpp"
#include "app/commands/help.hpp"
#include "app/session/reference_frame.hpp"
#include "app/session/session.hpp"
#include "app/support/output_file.hpp"
#include "app/support/progress.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "catchlight/track.hpp"
#include "catchlight/util/text.hpp"
#include "render/image/image_io.hpp"

namespace catchlight::app {
namespace {

struct Options {
  std::string recording, output, track_in;
  RecordingOverrides overrides;
  std::int64_t frame = 0;
  ReferenceQuality quality;
  bool overwrite = false;
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

/// The frame with the pose and the view that `overlay` would draw it by.
FrameJob viewed_frame(Session& session, std::int64_t frame) {
  const std::string& footage = session.recording().footage;
  if (session.footage().info().is_one_pass)
    throw UsageError(footage + ": a reference needs recorded footage, not a camera, a stream or a pipe");
  session.load_scene();
  while (std::optional<FrameJob> job = session.decode()) {
    session.track(*job);
    if (job->is_before_range) continue;
    if (!job->track.found)
      throw Error(footage + ": the tag is not found in frame " + std::to_string(frame) + "; " +
                  session.never_found().value_or("choose another --frame, or give its pose by --track"));
    session.view(*job);
    return std::move(*job);
  }
  throw Error(*session.damage());
}

void trace(const Options& options, Context& context) {
  const std::string output = options.output.empty() ? default_output(options.frame) : options.output;
  check_extension(output);
  check_output_path(output, options.overwrite);
  const auto start = std::chrono::steady_clock::now();
  Recording recording = open_recording(options.recording, options.overrides);
  std::vector<std::string> inputs = files_of(recording);
  inputs.push_back(options.track_in);
  refuse_shared_files({output}, inputs);
  Session session(std::move(recording),
                  {.task = "find frame", .range = {options.frame, options.frame + 1}, .track_file = options.track_in},
                  context.log);
  const FrameJob job = viewed_frame(session, options.frame);
  const Image traced = trace_reference_frame(job, session.settings(), session.load_scene(), options.quality,
                                             progress_handler(context.log, "reference"));
  if (std::filesystem::path(output).extension() == ".exr")
    render::write_exr(output, {{"", &traced, {"R", "G", "B"}}});
  else
    write_reference_png(output, traced, job.image, options.overwrite);
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  context.log.info(output + ": frame " + std::to_string(options.frame) + ", " + counted(options.quality.samples, "sample") +
                   " a pixel, " + counted(options.quality.bounces, "bounce") + ", " + fixed_text(elapsed_s, 1) + " s");
}

/// What the tracer finds by itself, and what it leaves out, is none of its parameters.
bool uses_parameter(const std::string& key) {
  for (const char* part : {"look", "exposure.key", "exposure.adapt", "glare.", "quality.", "lens.noise", "lens.motion_blur",
                           "lens.defocus", "lens.shutter", "lens.chroma_subsampling"})
    if (key.starts_with(part)) return false;
  return true;
}

}  // namespace

void set_up_reference(CLI::App& command, Context& context) {
  const auto options = std::make_shared<Options>();
  add_recording_options(command, context, options->recording, options->overrides, uses_parameter);
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
  show_examples(command, {"catchlight reference recordings/matte --frame 20 -o traced.png",
                          "catchlight reference recordings/matte --frame 20 --samples 4096 -o traced.exr"});
  command.callback([options, &context] { trace(*options, context); });
}

}  // namespace catchlight::app
