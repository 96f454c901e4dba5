// One row of the track a frame: pose and exposure. Tracked from the pictures, or read from a track file.
#pragma once

#include <memory>
#include <vector>

#include "app/media/frame.hpp"
#include "app/scene_settings.hpp"
#include "app/track_file.hpp"

namespace catchlight::app {

class FrameTrack {
 public:
  virtual ~FrameTrack() = default;

  /// Frames come in order, none left out.
  virtual TrackRow row(const Frame& frame) = 0;
};

/// Detects the tag and measures its photometry.
std::unique_ptr<FrameTrack> make_tag_track(const CameraModel& camera, const SceneSettings& scene);

/// Frames that `rows` does not have count as lost. Rows without exposure (bare poses) are measured in the pictures.
std::unique_ptr<FrameTrack> make_recorded_track(std::vector<TrackRow> rows, const CameraModel& camera,
                                                const SceneSettings& scene);

}  // namespace catchlight::app
