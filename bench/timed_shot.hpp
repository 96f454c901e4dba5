// A shot whose frames are in memory and tracked, and the clock that its stages are timed by.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/media/pixels/frame.hpp"
#include "app/settings/scene_settings.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/track.hpp"

namespace catchlight::app {

struct TimedShot {
  CameraModel camera;
  SceneSettings scene;
  std::vector<Frame> frames;
  std::vector<TrackRow> rows;  ///< one a frame
};

/// The first frames of a recording, at most so many. Throws Error as the recording and its footage do.
TimedShot read_shot(const std::string& folder, std::size_t max_frames);

/// Processor time of all threads of this process so far.
double processor_ms();

}  // namespace catchlight::app
