// One row of the track a frame: pose and exposure. Tracked from the pictures, or read from a track file.
#pragma once

#include <memory>
#include <vector>

#include "app/exposure.hpp"
#include "app/media/frame.hpp"
#include "app/scene_file.hpp"
#include "app/track_file.hpp"

namespace catchlight::app {

class FrameTrack {
 public:
  virtual ~FrameTrack() = default;

  /// Frames come in order, none left out.
  virtual TrackRow row(const Frame& frame) = 0;
};

/// Detects the tag and measures it. `tag_irradiance_over_pi`: see ExposureMatcher.
std::unique_ptr<FrameTrack> make_tag_track(const CameraModel& camera, const SceneSettings& scene,
                                           const glm::dvec3& tag_irradiance_over_pi);

/// Frames that the file does not have count as lost.
std::unique_ptr<FrameTrack> make_recorded_track(std::vector<TrackRow> rows);

}  // namespace catchlight::app
