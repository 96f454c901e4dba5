// What tracking costs beside decoding: processor time a frame, and how much that is of the AprilTag library's own detection of
// the same frames (in half the resolution). One line a recording and stage; medians of several interleaved rounds.
#include <cstdio>
#include <functional>
#include <map>

#include "app/session/frame_track.hpp"
#include "bench/timed_shot.hpp"
#include "catchlight/error.hpp"
#include "catchlight/util/statistics.hpp"
#include "tracking/camera/exposure_match.hpp"
#include "tracking/camera/grain.hpp"
#include "tracking/detection/detector.hpp"
#include "tracking/shot_tracker.hpp"
#include "tracking/tracker.hpp"

namespace {

using namespace catchlight;

constexpr std::size_t kMaxFrames = 96;
constexpr int kRounds = 5;
constexpr double kApart_s = 10;  ///< longer than any pose is predicted: each frame is the first

void detect(const app::TimedShot& shot) {
  tracking::Detector detector(shot.scene.tag.family, {});
  for (const app::Frame& frame : shot.frames) detector.detect(frame.luma(), 2);
}

void follow(const app::TimedShot& shot) {
  app::ShotTrack track(shot.camera, shot.scene);
  for (const app::Frame& frame : shot.frames) track.add(frame);
  track.solve();
}

void follow_pose(const app::TimedShot& shot) {
  tracking::ShotTracker tracker(shot.camera, shot.scene.tag.target(), {});
  for (const app::Frame& frame : shot.frames) tracker.add(frame.luma(), frame.time_s());
}

void find_anew(const app::TimedShot& shot) {
  tracking::Tracker tracker(shot.camera, shot.scene.tag.target(), {});
  double time_s = 0;
  for (const app::Frame& frame : shot.frames) tracker.track(frame.luma(), time_s += kApart_s);
}

void read_exposure(const app::TimedShot& shot) {
  tracking::ExposureMatch exposure(shot.camera, shot.scene.tag.target(), {});
  for (std::size_t i = 0; i < shot.frames.size(); ++i) exposure.add(shot.frames[i], shot.rows[i]);
}

void measure_grain(const app::TimedShot& shot) {
  tracking::GrainMeter grain(shot.camera, shot.scene.tag.target());
  for (std::size_t i = 0; i < shot.frames.size(); ++i) grain.add(shot.frames[i], shot.rows[i]);
}

struct Stage {
  const char* name;
  void (*run)(const app::TimedShot&);
};

constexpr Stage kStages[] = {{"detect", detect},          {"follow", follow},       {"of it pose", follow_pose},
                             {"exposure", read_exposure}, {"grain", measure_grain}, {"find anew", find_anew}};

void measure(const std::string& folder) {
  const app::TimedShot shot = app::read_shot(folder, kMaxFrames);
  std::map<std::string, std::vector<double>> times_ms;
  for (int round = 0; round < kRounds; ++round)
    for (const Stage& stage : kStages) {
      const double start_ms = app::processor_ms();
      stage.run(shot);
      times_ms[stage.name].push_back((app::processor_ms() - start_ms) / static_cast<double>(shot.frames.size()));
    }
  const double detect_ms = median(times_ms["detect"]);
  for (const Stage& stage : kStages) {
    const double ms = median(times_ms[stage.name]);
    std::printf("%-24s %-12s %8.2f ms %6.2f of detection\n", folder.c_str(), stage.name, ms, ms / detect_ms);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    for (int i = 1; i < argc; ++i) measure(argv[i]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
