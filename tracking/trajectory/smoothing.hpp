// Smooths a trajectory by how certain each of its poses is: not at all where they are sharp, firmly where they are not.
#pragma once

#include <span>
#include <vector>

#include "catchlight/rigid_transform.hpp"
#include "tracking/observation.hpp"

namespace catchlight::tracking {

struct TimedCandidate {
  double time_s = 0;
  PoseCandidate pose;
};

struct SmoothedPose {
  RigidTransform camera_from_tag;
  PoseCovariance covariance{};
};

/// Rauch, Tung and Striebel's smoother (1965) of rotation and translation with constant velocity and white accelerations, on
/// the poses' own covariances. How strong the accelerations are is found around each moment by maximum likelihood: a hand at rest
/// and a swing within one trajectory each get their own. Results at `at_s`, which may lie between measurements, or after them; in
/// rising order, as are `measured`, of which there is at least one.
std::vector<SmoothedPose> smooth_trajectory(std::span<const TimedCandidate> measured, std::span<const double> at_s);

}  // namespace catchlight::tracking
