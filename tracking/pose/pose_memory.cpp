#include "tracking/pose/pose_memory.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/rotation.hpp"

namespace catchlight::tracking {
namespace {

/// How far a frame's orientation strays from steady motion: noise of a small tag, and the hand's acceleration.
constexpr double kTurnNoise_rad = 0.09, kTurnNoise_rad_per_s = 0.6;
/// A continuation is never quite impossible, nor a hypothesis quite dead: history has to stay correctable.
constexpr double kMinContinuity = 1e-3, kMinProbability = 1e-4;
/// Steady gains of the alpha-beta filter, nearly critically damped (beta = alpha² / (2 − alpha)).
constexpr double kPositionGain = 0.4, kVelocityGain = 0.1;
/// The other pose has to be this much likelier before the choice changes.
constexpr double kSwitchOdds = 3;

/// How well an orientation continues the predicted one, from 0 to 1.
double continuity(const glm::dmat3& predicted, const glm::dmat3& seen, double dt_s) {
  const double turn = angle_between_rad(predicted, seen);
  const double sigma = std::hypot(kTurnNoise_rad, kTurnNoise_rad_per_s * dt_s);
  return std::exp(-0.5 * turn * turn / (sigma * sigma));
}

}  // namespace

RigidTransform PoseMemory::moved(const Hypothesis& from, const RigidTransform& pose, double dt_s) {
  return {rotation_matrix(from.turn_rad_per_s * dt_s) * pose.rotation, pose.translation_m + from.velocity_m_per_s * dt_s};
}

/// Alpha-beta filter. Its gains start as those of the straight line fitted to all frames so far, so that two frames
/// already give the velocity between them.
PoseMemory::Hypothesis PoseMemory::continued(const Hypothesis& before, const RigidTransform& camera_from_tag, double dt_s) {
  Hypothesis now{camera_from_tag, camera_from_tag};
  if (!(dt_s > 0)) return now;
  now.frames = before.frames + 1;
  const double n = now.frames;
  const double position_gain = std::max(kPositionGain, 2 * (2 * n - 1) / (n * (n + 1)));
  const double velocity_gain = std::max(kVelocityGain, 6 / (n * (n + 1)));
  const RigidTransform expected = moved(before, before.smoothed, dt_s);
  const glm::dvec3 surprise_m = camera_from_tag.translation_m - expected.translation_m;
  const glm::dvec3 surprise_rad = rotation_vector(camera_from_tag.rotation * glm::transpose(expected.rotation));
  now.smoothed = {rotation_matrix(position_gain * surprise_rad) * expected.rotation,
                  expected.translation_m + position_gain * surprise_m};
  now.velocity_m_per_s = before.velocity_m_per_s + velocity_gain / dt_s * surprise_m;
  now.turn_rad_per_s = before.turn_rad_per_s + velocity_gain / dt_s * surprise_rad;
  return now;
}

/// Joined to the likeliest hypothesis it may continue; its probability is the sum over all of them.
PoseMemory::Hypothesis PoseMemory::with_history(const PoseCandidate& seen, double dt_s) const {
  Hypothesis now{seen.camera_from_tag, seen.camera_from_tag};
  double probability = count_ == 0 ? 1 : 0, largest = 0;
  for (std::size_t j = 0; j < count_; ++j) {
    const RigidTransform expected = moved(hypotheses_[j], hypotheses_[j].smoothed, dt_s);
    const double fits = continuity(expected.rotation, seen.camera_from_tag.rotation, dt_s) + kMinContinuity;
    const double share = fits * hypotheses_[j].probability;
    probability += share;
    if (share > largest) {
      largest = share;
      now = continued(hypotheses_[j], seen.camera_from_tag, dt_s);
    }
  }
  now.probability = probability;
  return now;
}

/// Which of this frame's hypotheses continues the pose chosen last.
std::size_t PoseMemory::heir(std::span<const Hypothesis> now, double dt_s) const {
  if (now.size() < 2) return 0;
  const glm::dmat3 expected = moved(hypotheses_[chosen_], hypotheses_[chosen_].smoothed, dt_s).rotation;
  const double turn_0 = angle_between_rad(expected, now[0].camera_from_tag.rotation);
  const double turn_1 = angle_between_rad(expected, now[1].camera_from_tag.rotation);
  return turn_1 < turn_0 ? 1 : 0;
}

std::size_t PoseMemory::choose(std::span<const PoseCandidate> candidates, double time_s) {
  const std::span<const PoseCandidate> seen = candidates.first(std::min<std::size_t>(candidates.size(), 2));
  const double dt_s = time_s - time_s_;
  double best = -std::numeric_limits<double>::infinity();
  for (const PoseCandidate& candidate : seen) best = std::max(best, candidate.log_likelihood);
  std::array<Hypothesis, 2> now{};
  double sum = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    now[i] = with_history(seen[i], dt_s);
    now[i].probability *= std::exp(seen[i].log_likelihood - best);
    sum += now[i].probability;
  }
  for (std::size_t i = 0; i < seen.size(); ++i)
    now[i].probability = std::max(now[i].probability / std::max(sum, 1e-300), kMinProbability);

  const std::size_t likelier = seen.size() == 2 && now[1].probability > now[0].probability ? 1 : 0;
  const std::size_t kept = count_ == 0 ? likelier : heir(std::span(now).first(seen.size()), dt_s);
  chosen_ = now[likelier].probability > kSwitchOdds * now[kept].probability ? likelier : kept;
  hypotheses_ = now;
  count_ = seen.size();
  time_s_ = time_s;
  return chosen_;
}

std::optional<RigidTransform> PoseMemory::predict(double time_s) const {
  if (count_ == 0) return std::nullopt;
  return moved(hypotheses_[chosen_], hypotheses_[chosen_].camera_from_tag, time_s - time_s_);
}

double PoseMemory::ambiguity() const {
  if (count_ < 2) return 0;
  return hypotheses_[1 - chosen_].probability / (hypotheses_[0].probability + hypotheses_[1].probability);
}

void PoseMemory::forget() {
  *this = {};
}

}  // namespace catchlight::tracking
