// The whole trajectory of recorded footage, from what each frame alone allows.
#pragma once

#include <span>
#include <vector>

#include "catchlight/rigid_transform.hpp"
#include "catchlight/track.hpp"
#include "tracking/observation.hpp"
#include "tracking/trajectory/branches.hpp"

namespace catchlight::tracking {

struct SolvedPose {
  TrackState state = TrackState::lost;
  RigidTransform camera_from_tag;
  PoseCovariance covariance{};
  double ambiguity = 0;
};

/// Chooses between the planar poses over each stretch of frames, smooths it by the covariances, and bridges gaps of up to
/// `coast_s` from both sides; after a stretch's end, its motion goes on for as long. Frames in rising order of time.
std::vector<SolvedPose> solve_trajectory(std::span<const TrajectoryFrame> frames, double coast_s);

}  // namespace catchlight::tracking
