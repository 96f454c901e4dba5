#include "tracking/pose_memory.hpp"

#include <algorithm>
#include <glm/gtc/quaternion.hpp>

namespace catchlight::tracking {
namespace {

/// Refined corners are about this good per axis; calibration and lens models are hardly better.
constexpr double kCornerNoisePx = 0.05;
/// How far a frame's orientation strays from constant velocity: noise of a small tag, and the hand's acceleration.
constexpr double kTurnNoise_rad = 0.09;
constexpr double kTurnNoise_rad_per_s = 0.6;
/// A continuation is never quite impossible; this bounds what history can weigh against the present.
constexpr double kLeastContinuity = 1e-3;
constexpr double kLeastProbability = 1e-4;
/// The velocity is smoothed over frames: differences of noisy poses alone would be worse than standing still.
constexpr double kVelocityGain = 0.4;
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

/// exp(−χ²/2) of each hypothesis' corners, with the noise no smaller than what the better one leaves over:
/// corners that neither pose explains say little about which is right.
std::array<double, 2> fit_likelihoods(std::span<const PoseHypothesis> hypotheses) {
  double best = std::numeric_limits<double>::infinity();
  for (const auto& hypothesis : hypotheses) best = std::min(best, hypothesis.reprojection_rms_px);
  // Eight coordinates less six unknowns leave two degrees of freedom: 4 rms² = 2 variances.
  const double variance = std::max(kCornerNoisePx * kCornerNoisePx, 2 * best * best);
  std::array<double, 2> likelihoods{};
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    const double rms = hypotheses[i].reprojection_rms_px;
    likelihoods[i] = std::exp(-0.5 * 4 * (rms * rms - best * best) / variance);
  }
  return likelihoods;
}

}  // namespace

RigidTransform PoseMemory::moved(const Hypothesis& from, double dt_s) {
  return {rotation_matrix(from.turn_rad_per_s * dt_s) * from.camera_from_tag.rotation,
          from.camera_from_tag.translation_m + from.velocity_m_per_s * dt_s};
}

PoseMemory::Hypothesis PoseMemory::continued(const Hypothesis& before, const RigidTransform& camera_from_tag, double dt_s) {
  Hypothesis now{camera_from_tag};
  if (!(dt_s > 0)) return now;
  const glm::dvec3 velocity = (camera_from_tag.translation_m - before.camera_from_tag.translation_m) / dt_s;
  const glm::dvec3 turn = rotation_vector(camera_from_tag.rotation * glm::transpose(before.camera_from_tag.rotation)) / dt_s;
  now.velocity_m_per_s = glm::mix(before.velocity_m_per_s, velocity, kVelocityGain);
  now.turn_rad_per_s = glm::mix(before.turn_rad_per_s, turn, kVelocityGain);
  return now;
}

std::size_t PoseMemory::choose(std::span<const PoseHypothesis> hypotheses, double time_s) {
  const std::size_t count = std::min<std::size_t>(hypotheses.size(), 2);
  const auto fit = fit_likelihoods(hypotheses.first(count));
  const double dt_s = time_s - time_s_;
  const double sigma = std::hypot(kTurnNoise_rad, kTurnNoise_rad_per_s * dt_s);

  std::array<Hypothesis, 2> now{};
  std::size_t heir = 0;  // the hypothesis that continues the one chosen before
  double heir_share = -1;
  for (std::size_t i = 0; i < count; ++i) {
    now[i] = {hypotheses[i].camera_from_tag};
    double prior = count_ == 0 ? 1 : 0, best_share = -1;
    for (std::size_t j = 0; j < count_; ++j) {
      const double turn = angle_between(moved(hypotheses_[j], dt_s).rotation, now[i].camera_from_tag.rotation);
      const double continuity = std::exp(-0.5 * turn * turn / (sigma * sigma)) + kLeastContinuity;
      const double share = continuity * hypotheses_[j].probability;
      prior += share;
      if (share > best_share) {
        best_share = share;
        const double kept_probability = now[i].probability;
        now[i] = continued(hypotheses_[j], hypotheses[i].camera_from_tag, dt_s);
        now[i].probability = kept_probability;
      }
      if (j == chosen_ && continuity > heir_share) {
        heir_share = continuity;
        heir = i;
      }
    }
    now[i].probability = prior * fit[i];
  }

  const double sum = std::max(now[0].probability + now[1].probability, std::numeric_limits<double>::min());
  for (std::size_t i = 0; i < count; ++i) now[i].probability = std::max(now[i].probability / sum, kLeastProbability);
  const std::size_t likelier = count == 2 && now[1].probability > now[0].probability ? 1 : 0;
  const bool switches = count_ == 0 || now[likelier].probability > kSwitchOdds * now[heir].probability;
  chosen_ = switches ? likelier : heir;
  hypotheses_ = now;
  count_ = count;
  time_s_ = time_s;
  return chosen_;
}

std::optional<RigidTransform> PoseMemory::predict(double time_s) const {
  if (count_ == 0) return std::nullopt;
  return moved(hypotheses_[chosen_], time_s - time_s_);
}

void PoseMemory::forget() {
  *this = {};
}

}  // namespace catchlight::tracking
