// How far three poses are from steady motion, and how uncertain that is.
#pragma once

#include <glm/glm.hpp>

#include "tracking/observation.hpp"

namespace catchlight::tracking {

/// A deviation and the covariance that the measurements alone give it.
struct Unsteadiness {
  glm::dvec3 deviation{0.0};
  glm::dmat3 covariance{0.0};
};

struct TimedPose {
  double time_s;
  const PoseCandidate* pose;
};

/// How far the third orientation (rad) is from where the first two, turning on steadily, lead.
Unsteadiness unsteady_turn(const TimedPose& first, const TimedPose& second, const TimedPose& third);

/// How far the third position (m) is from where the first two lead.
Unsteadiness unsteady_shift(const TimedPose& first, const TimedPose& second, const TimedPose& third);

/// How far the second orientation (rad) is from the first.
Unsteadiness plain_turn(const PoseCandidate& first, const PoseCandidate& second);

/// Log of the normal density of the deviation, whose true part has `variance` per axis.
double log_density(const Unsteadiness& unsteadiness, double variance);

}  // namespace catchlight::tracking
