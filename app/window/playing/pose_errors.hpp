// How sure the pose of each frame of a shot is, and how far it is off where the truth is known.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/track.hpp"

namespace catchlight::app {

struct PoseError {
  std::int64_t frame = 0;
  TrackState state = TrackState::lost;
  double sigma_px = 0;                               ///< of the tag's corners, by the track
  std::optional<double> off_px, off_mm, turned_deg;  ///< against the true pose, of the corners; empty where that is not known
};

/// One entry a row. `truth`: rows of the true poses, paired by frame; empty where they are not known.
std::vector<PoseError> pose_errors(const std::vector<TrackRow>& rows, const std::vector<TrackRow>& truth,
                                   const CameraModel& camera, double tag_size_m);

}  // namespace catchlight::app
