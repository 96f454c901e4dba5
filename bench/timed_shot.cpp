#include "bench/timed_shot.hpp"

#include <ctime>

#include "app/media/read/source.hpp"
#include "app/session/frame_track.hpp"
#include "app/session/recording.hpp"

namespace catchlight::app {

TimedShot read_shot(const std::string& folder, std::size_t max_frames) {
  const Recording recording = open_recording(folder);
  const auto source = open_footage(recording);
  TimedShot shot{camera_for_footage(recording, source->info().width_px, source->info().height_px), recording.scene, {}, {}};
  while (shot.frames.size() < max_frames) {
    auto frame = source->read();
    if (!frame) break;
    shot.frames.push_back(std::move(*frame));
  }
  ShotTrack track(shot.camera, shot.scene);
  for (const Frame& frame : shot.frames) track.add(frame);
  shot.rows = track.solve();
  return shot;
}

double processor_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

}  // namespace catchlight::app
