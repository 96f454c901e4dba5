#include "tracking/pose/corner_noise.hpp"

#include <cmath>

#include "tracking/pose/pose_covariance.hpp"

namespace catchlight::tracking {
namespace {

/// Refined corners are about this good per axis; calibration and lens models are hardly better.
constexpr double kCornerNoisePx = 0.05;
/// What that expectation weighs against the frames seen, and how fast those are forgotten.
constexpr double kExpectationFrames = 3, kMemory = 0.95;

}  // namespace

std::vector<PoseCandidate> CornerNoise::candidates(const CameraModel& camera, std::span<const PoseHypothesis> poses,
                                                   double size_m) {
  std::vector<PoseCandidate> candidates;
  if (poses.empty()) return candidates;
  // Eight coordinates less six unknowns leave two degrees of freedom: the best pose's 4·rms² estimates two variances.
  const double best_rms_px = poses[0].reprojection_rms_px;
  sum_px2_ = kMemory * sum_px2_ + 2 * best_rms_px * best_rms_px;
  weight_ = kMemory * weight_ + 1;
  const double expected_px2 = kExpectationFrames * kCornerNoisePx * kCornerNoisePx;
  const double noise_px2 = (sum_px2_ + expected_px2) / (weight_ + kExpectationFrames);
  for (const PoseHypothesis& pose : poses) {
    const double log_likelihood = -2 * pose.reprojection_rms_px * pose.reprojection_rms_px / noise_px2;
    candidates.push_back({pose.camera_from_tag,
                          covariance_from_corners(camera, pose.camera_from_tag, size_m, std::sqrt(noise_px2)), log_likelihood});
  }
  return candidates;
}

}  // namespace catchlight::tracking
