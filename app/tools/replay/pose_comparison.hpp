// A track against known poses.
#pragma once

#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/track.hpp"

namespace catchlight::app {

struct PoseComparison {
  int frames = 0;                               ///< frames whose known pose has all four corners in the picture
  int tracked = 0;                              ///< those of them with a pose of ours
  int false_positives = 0;                      ///< frames with a pose of ours though no corner is in the picture
  double corner_rms_px = 0, corner_p95_px = 0;  ///< distance of the tag's projected corners
  double translation_median_mm = 0;
  double rotation_median_deg = 0, rotation_max_deg = 0;
  int flips = 0;  ///< frames off by more than 8 degrees: the other planar pose
};

/// Frames are paired by number. Corners are those of a tag of `tag_size_m`, projected without distortion. Frames with some of
/// them in the picture count neither way.
PoseComparison compare_poses(const std::vector<TrackRow>& ours, const std::vector<TrackRow>& truth, const CameraModel& camera,
                             double tag_size_m);

}  // namespace catchlight::app
