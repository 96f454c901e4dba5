#include "tracking/pose_memory.hpp"

#include <algorithm>
#include <glm/gtc/quaternion.hpp>

namespace catchlight::tracking {
namespace {

/// Refined corners are about this good per axis; calibration and lens models are hardly better.
constexpr double kCornerNoisePx = 0.05;
/// What that expectation weighs against the frames seen, and how fast those are forgotten.
constexpr double kExpectationFrames = 3, kNoiseMemory = 0.95;
/// How far a frame's orientation strays from steady motion: noise of a small tag, and the hand's acceleration.
constexpr double kTurnNoise_rad = 0.09, kTurnNoise_rad_per_s = 0.6;
/// A continuation is never quite impossible, nor a hypothesis quite dead: history has to stay correctable.
constexpr double kLeastContinuity = 1e-3, kLeastProbability = 1e-4;
/// Steady gains of the alpha-beta filter, nearly critically damped (beta = alpha² / (2 − alpha)).
constexpr double kPositionGain = 0.4, kVelocityGain = 0.1;
/// The other pose has to be this much likelier before the choice changes.
constexpr double kSwitchOdds = 3;

glm::dvec3 rotation_vector(const glm::dmat3& rotation) {
  glm::dquat q = glm::quat_cast(rotation);
  if (q.w < 0) q = -q;
  const glm::dvec3 axis(q.x, q.y, q.z);
  const double sine = glm::length(axis);
  if (sine < 1e-12) return 2.0 * axis;
  return axis * (2 * std::atan2(sine, q.w) / sine);
}

glm::dmat3 rotation_matrix(const glm::dvec3& rotation_vector_rad) {
  const double angle = glm::length(rotation_vector_rad);
  if (angle < 1e-12) return glm::dmat3(1.0);
  return glm::mat3_cast(glm::angleAxis(angle, rotation_vector_rad / angle));
}

double angle_between(const glm::dmat3& a, const glm::dmat3& b) {
  return glm::length(rotation_vector(b * glm::transpose(a)));
}

/// How well an orientation continues the predicted one, from 0 to 1.
double continuity(const glm::dmat3& predicted, const glm::dmat3& seen, double dt_s) {
  const double turn = angle_between(predicted, seen);
  const double sigma = std::hypot(kTurnNoise_rad, kTurnNoise_rad_per_s * dt_s);
  return std::exp(-0.5 * turn * turn / (sigma * sigma));
}

/// Eight coordinates less six unknowns leave two degrees of freedom: the best pose's 4·rms² estimates two variances.
double variance_px2(double best_rms_px) {
  return 2 * best_rms_px * best_rms_px;
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
PoseMemory::Hypothesis PoseMemory::with_history(const PoseHypothesis& seen, double dt_s) const {
  Hypothesis now{seen.camera_from_tag, seen.camera_from_tag};
  double probability = count_ == 0 ? 1 : 0, largest = 0;
  for (std::size_t j = 0; j < count_; ++j) {
    const RigidTransform expected = moved(hypotheses_[j], hypotheses_[j].smoothed, dt_s);
    const double fits = continuity(expected.rotation, seen.camera_from_tag.rotation, dt_s) + kLeastContinuity;
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
  const double turn_0 = angle_between(expected, now[0].camera_from_tag.rotation);
  const double turn_1 = angle_between(expected, now[1].camera_from_tag.rotation);
  return turn_1 < turn_0 ? 1 : 0;
}

void PoseMemory::learn_noise(double best_rms_px) {
  noise_sum_px2_ = kNoiseMemory * noise_sum_px2_ + variance_px2(best_rms_px);
  noise_weight_ = kNoiseMemory * noise_weight_ + 1;
}

std::size_t PoseMemory::choose(std::span<const PoseHypothesis> hypotheses, double time_s) {
  const std::span<const PoseHypothesis> seen = hypotheses.first(std::min<std::size_t>(hypotheses.size(), 2));
  const double dt_s = time_s - time_s_;
  double best_rms_px = std::numeric_limits<double>::infinity();
  for (const PoseHypothesis& hypothesis : seen) best_rms_px = std::min(best_rms_px, hypothesis.reprojection_rms_px);
  // One frame's own residual says little about the noise: the smallest would make chance look like certainty.
  learn_noise(best_rms_px);
  const double expected_px2 = kExpectationFrames * kCornerNoisePx * kCornerNoisePx;
  const double noise_px2 = (noise_sum_px2_ + expected_px2) / (noise_weight_ + kExpectationFrames);

  std::array<Hypothesis, 2> now{};
  double sum = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    now[i] = with_history(seen[i], dt_s);
    const double worse_px2 = 4 * (seen[i].reprojection_rms_px * seen[i].reprojection_rms_px - best_rms_px * best_rms_px);
    now[i].probability *= std::exp(-0.5 * worse_px2 / noise_px2);
    sum += now[i].probability;
  }
  for (std::size_t i = 0; i < seen.size(); ++i)
    now[i].probability = std::max(now[i].probability / std::max(sum, 1e-300), kLeastProbability);

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

void PoseMemory::forget() {
  *this = {};
}

}  // namespace catchlight::tracking
