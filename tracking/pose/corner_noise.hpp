// How exact corners are, learned from what single poses leave of them.
#pragma once

#include <span>
#include <vector>

#include "catchlight/camera.hpp"
#include "tracking/observation.hpp"
#include "tracking/pose/planar_pose.hpp"

namespace catchlight::tracking {

/// One frame's own residual says little about the noise: the smallest would make chance look like certainty. So an expectation
/// and the frames before count as well.
class CornerNoise {
 public:
  /// `poses` of one frame, the better first, as candidates: likelihood and covariance of corners as noisy as seen so far.
  std::vector<PoseCandidate> candidates(const CameraModel& camera, std::span<const PoseHypothesis> poses, double size_m);

 private:
  double sum_px2_ = 0, weight_ = 0;  ///< sums over the corners' variances per axis
};

}  // namespace catchlight::tracking
