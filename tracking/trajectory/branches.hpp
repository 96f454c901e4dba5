// Which of two planar poses is the right one, decided over a whole trajectory.
#pragma once

#include <span>
#include <vector>

#include "tracking/observation.hpp"

namespace catchlight::tracking {

/// One frame's measurement: one or two candidates, or none where the tag was not seen.
struct TrajectoryFrame {
  double time_s = 0;
  std::vector<PoseCandidate> candidates;
};

struct Branch {
  std::size_t candidate = 0;
  double ambiguity = 0;  ///< probability that the other one is right, 0 where there is none
};

/// A hidden Markov chain of second order: what each frame's pixels say, and how steadily three frames turn. The likeliest
/// sequence by Viterbi's algorithm, the ambiguity that is left by the forward-backward one. Every frame has candidates.
std::vector<Branch> choose_branches(std::span<const TrajectoryFrame* const> frames);

}  // namespace catchlight::tracking
