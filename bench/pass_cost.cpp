// What each pass of a recording's frames costs: `pass_cost cpu|gl FRAMES FOLDER...` prints "FOLDER COLUMN MS", medians over the
// frames. The process keeps to one core, so that a pass's time is its processor time; what other work takes of that core is
// taken out again. What rays, lights and samples cost is what the object pass costs less without them, on the same frames.
#include <sched.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <numeric>
#include <stdexcept>

#include "app/media/read/source.hpp"
#include "app/media/write/frame_output.hpp"
#include "app/session/frame_job.hpp"
#include "app/session/frame_track.hpp"
#include "app/session/recording.hpp"
#include "app/session/shot_renderer.hpp"
#include "bench/timed_shot.hpp"
#include "catchlight/util/statistics.hpp"

namespace {

using namespace catchlight;
using namespace catchlight::app;

using Times = std::map<std::string, std::vector<double>>;  ///< milliseconds a frame, by column

void keep_to_one_core() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(sched_getcpu(), &cores);
  sched_setaffinity(0, sizeof cores, &cores);
}

/// The column of the table that a pass belongs to; what has none of its own is part of the composite.
std::string column_of(const std::string& pass) {
  if (pass == "light") return "light";
  if (pass == "object" || pass == "receiver" || pass == "lens blur") return pass;
  return "composite";
}

struct Variant {
  const char* column;  ///< what is left out of the object pass
  std::unique_ptr<ShotRenderer> renderer;
};

/// As the recording has it, without rays, without lights of their own, with one sample a pixel.
std::vector<Variant> variants(const TimedShot& shot, Log& log) {
  std::vector<Variant> result;
  const auto add = [&](const char* column, auto change) {
    SceneSettings scene = shot.scene;
    change(scene.quality);
    result.push_back({column, std::make_unique<ShotRenderer>(scene, shot.camera, ShotRenderer::Wanted{}, log)});
    result.back().renderer->prepare();
  };
  add("object", [](auto&) {});
  add("rays", [](auto& quality) { quality.reflection_rays = 0; });
  add("lights", [](auto& quality) { quality.light_samples = 0; });
  add("samples", [](auto& quality) { quality.samples = 1; });
  return result;
}

/// Processor time of each column for one frame, which is drawn into `job`.
std::map<std::string, double> draw(ShotRenderer& renderer, FrameJob& job) {
  renderer.open_renderer();
  const double start_ms = processor_ms();
  renderer.render(job);
  const double spent_ms = processor_ms() - start_ms;
  double passes_ms = 0;
  for (const render::PassTime& pass : renderer.pass_times()) passes_ms += pass.ms;
  std::map<std::string, double> result;
  for (const render::PassTime& pass : renderer.pass_times()) result[column_of(pass.name)] += pass.ms * spent_ms / passes_ms;
  return result;
}

void time_drawing(const TimedShot& shot, Renderer renderer, std::vector<FrameJob>& jobs, Times& times) {
  Log log;
  log.set_quiet(true);
  TimedShot drawn = shot;
  drawn.scene.renderer = renderer;
  const std::vector<Variant> all = variants(drawn, log);
  FrameJob first = jobs.front();
  for (const Variant& variant : all) variant.renderer->render(first);  // what is kept from frame to frame is made once
  for (FrameJob& job : jobs) {
    const std::map<std::string, double> whole = draw(*all.front().renderer, job);
    for (const auto& [column, ms] : whole) times[column].push_back(ms);
    for (std::size_t i = 1; i < all.size(); ++i) {
      FrameJob less = {.image = job.image, .track = job.track};
      times[all[i].column].push_back(whole.at("object") - draw(*all[i].renderer, less).at("object"));
    }
  }
}

/// x264 works behind the writer, so only the mean of all frames is known.
void time_encoding(const std::string& folder, const std::vector<FrameJob>& jobs, Times& times) {
  const Recording recording = open_recording(folder);
  const auto source = open_footage(recording);
  const std::string path = std::filesystem::temp_directory_path() / ("pass_cost." + std::to_string(getpid()) + ".mp4");
  const auto output = open_output(path, recording.footage, *source, {.codec = {}, .crf = 23, .frames = {}});
  const double start_ms = processor_ms();
  for (const FrameJob& job : jobs) output->write(job.image, job.result, {});
  output->finish();
  times["encode"].push_back((processor_ms() - start_ms) / static_cast<double>(jobs.size()));
  std::filesystem::remove(path);
}

void time_tracking(const TimedShot& shot, Times& times) {
  const double start_ms = processor_ms();
  ShotTrack track(shot.camera, shot.scene);
  for (const Frame& frame : shot.frames) track.add(frame);
  track.solve();
  times["track"].push_back((processor_ms() - start_ms) / static_cast<double>(shot.frames.size()));
}

void measure(const std::string& folder, Renderer renderer, std::size_t max_frames) {
  const TimedShot shot = read_shot(folder, max_frames);
  std::vector<FrameJob> jobs;
  for (std::size_t i = 0; i < shot.frames.size(); ++i)
    if (shot.rows[i].found) jobs.push_back({.image = shot.frames[i], .track = shot.rows[i]});
  if (jobs.empty()) throw std::runtime_error(folder + ": the tag is found in none of the frames");
  Times times;
  time_drawing(shot, renderer, jobs, times);
  time_encoding(folder, jobs, times);
  time_tracking(shot, times);
  for (const auto& [column, ms] : times) std::printf("%s\t%s\t%.3f\n", folder.c_str(), column.c_str(), median(ms));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 4) throw std::runtime_error("usage: pass_cost cpu|gl FRAMES FOLDER...");
    keep_to_one_core();
    for (int i = 3; i < argc; ++i)
      measure(argv[i], argv[1] == std::string("gl") ? Renderer::gl : Renderer::cpu, std::stoul(argv[2]));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
