// Chooses between the two planar poses with the memory of earlier frames, and predicts where the tag will be.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "catchlight/rigid_transform.hpp"
#include "tracking/observation.hpp"

namespace catchlight::tracking {

/// A hidden Markov chain of two states, the two hypotheses of each frame. A hypothesis is likely when it fits its frame
/// and when it continues, at constant velocity, a hypothesis that was likely in the frame before. So evidence adds up
/// over frames, follows each hypothesis through the moment where both coincide, and corrects a wrong first choice; what
/// one frame says is bounded, so that no single one overrules a long history.
class PoseMemory {
 public:
  /// `candidates`: one or two. Returns the index of the chosen one.
  std::size_t choose(std::span<const PoseCandidate> candidates, double time_s);

  /// Probability that the other pose is the right one; 0 where there is none.
  double ambiguity() const;

  /// The chosen pose moved on to `time_s` at the velocity of the last frames; empty before the first frame.
  std::optional<RigidTransform> predict(double time_s) const;

  /// Time of the last choose().
  double last_time_s() const { return time_s_; }

  void forget();

 private:
  struct Hypothesis {
    RigidTransform camera_from_tag;  ///< as measured
    RigidTransform smoothed;         ///< what the frames before and this one make likely
    glm::dvec3 velocity_m_per_s{0};
    glm::dvec3 turn_rad_per_s{0};  ///< in the camera frame
    int frames = 1;                ///< how many it continues
    double probability = 0;
  };
  static RigidTransform moved(const Hypothesis& from, const RigidTransform& pose, double dt_s);
  static Hypothesis continued(const Hypothesis& before, const RigidTransform& camera_from_tag, double dt_s);
  Hypothesis with_history(const PoseCandidate& seen, double dt_s) const;
  std::size_t heir(std::span<const Hypothesis> now, double dt_s) const;

  std::array<Hypothesis, 2> hypotheses_{};
  std::size_t count_ = 0, chosen_ = 0;
  double time_s_ = 0;
};

}  // namespace catchlight::tracking
