#include "tracking/trajectory/smoothing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>

#include "catchlight/rotation.hpp"
#include "tracking/trajectory/steadiness.hpp"

namespace catchlight::tracking {
namespace {

using Matrix = cv::Matx<double, 12, 12>;
using Vector = cv::Matx<double, 12, 1>;

/// Spectral densities of acceleration that are tried: from a tripod to a jolt, (rad or m)²/s³.
constexpr int kLevels = 33;
constexpr double kLowestTurn = 1e-8, kLowestShift = 1e-10, kLevelFactor = 2.5;
/// A level is only rejected where another explains the motion better by this: the likelihood-ratio test at 95 %. Of those that
/// remain the quietest counts; the likeliest alone is often too restless by chance.
constexpr double kRejection = 1.92;
constexpr std::size_t kWindowFrames = 4, kWidestSpacing = 16;

/// State: small rotation and translation errors, then angular and linear velocity. The mean holds what the errors are from.
struct State {
  RigidTransform pose;
  glm::dvec3 turn_rad_per_s{0}, velocity_m_per_s{0};
  Matrix covariance = Matrix::zeros();
};

/// How strongly the motion changes around one measurement.
struct Unrest {
  double turn = kLowestTurn, shift = kLowestShift;
};

double level(double lowest, int k) {
  return lowest * std::pow(kLevelFactor, k);
}

/// Log-likelihoods of all levels at one triple of poses.
using Levels = std::array<double, kLevels>;

Levels likelihoods(const Unsteadiness& deviation, double lowest, double lag_s, double lag_before_s) {
  // White acceleration of density q moves the third pose off the line through two by this variance over q.
  const double gain = lag_s * lag_s * (lag_s + lag_before_s) / 3;
  Levels result;
  for (int k = 0; k < kLevels; ++k) result[static_cast<std::size_t>(k)] = log_density(deviation, level(lowest, k) * gain);
  return result;
}

/// The quietest levels that explain the motion around each measurement, at one spacing of the triples.
void raise_to_quietest(std::span<const TimedCandidate> trajectory, const std::vector<Levels>& at_triples, std::size_t spacing,
                       double lowest, std::vector<double>& levels) {
  const std::size_t reach = std::max(spacing, kWindowFrames);
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    Levels sum{};
    for (std::size_t k = 0; k < at_triples.size(); ++k) {
      const std::size_t middle = k + spacing;
      if (middle + reach < i || middle > i + reach) continue;
      for (std::size_t l = 0; l < kLevels; ++l) sum[l] += at_triples[k][l];
    }
    const double least = *std::max_element(sum.begin(), sum.end()) - kRejection;
    const auto quietest = std::find_if(sum.begin(), sum.end(), [&](double each) { return each >= least; });
    levels[i] = std::max(levels[i], level(lowest, static_cast<int>(quietest - sum.begin())));
  }
}

/// Real accelerations last for a while: over neighbouring frames they drown in noise, over more they stand out. So triples of
/// all spacings are asked, and the most restless answer counts.
std::vector<Unrest> unrest_of(std::span<const TimedCandidate> trajectory) {
  std::vector<double> turn(trajectory.size(), kLowestTurn), shift(trajectory.size(), kLowestShift);
  for (std::size_t spacing = 1; spacing <= kWidestSpacing && 2 * spacing < trajectory.size(); spacing *= 2) {
    std::vector<Levels> turns, shifts;
    for (std::size_t i = 2 * spacing; i < trajectory.size(); ++i) {
      const auto timed = [&](std::size_t k) { return TimedPose{trajectory[k].time_s, &trajectory[k].pose}; };
      const TimedPose first = timed(i - 2 * spacing), second = timed(i - spacing), third = timed(i);
      const double lag_s = third.time_s - second.time_s, lag_before_s = second.time_s - first.time_s;
      turns.push_back(likelihoods(unsteady_turn(first, second, third), kLowestTurn, lag_s, lag_before_s));
      shifts.push_back(likelihoods(unsteady_shift(first, second, third), kLowestShift, lag_s, lag_before_s));
    }
    raise_to_quietest(trajectory, turns, spacing, kLowestTurn, turn);
    raise_to_quietest(trajectory, shifts, spacing, kLowestShift, shift);
  }
  std::vector<Unrest> result;
  for (std::size_t i = 0; i < trajectory.size(); ++i) result.push_back({turn[i], shift[i]});
  return result;
}

State first_state(const PoseCandidate& measured) {
  constexpr double kTurn = 3, kVelocity = 3;  // rad/s, m/s: any
  State state{measured.camera_from_tag};
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) state.covariance(i, j) = measured.covariance[static_cast<std::size_t>(6 * i + j)];
  for (int i = 0; i < 3; ++i) {
    state.covariance(6 + i, 6 + i) = kTurn * kTurn;
    state.covariance(9 + i, 9 + i) = kVelocity * kVelocity;
  }
  return state;
}

struct Prediction {
  State state;
  Matrix transition;
};

Prediction predict(const State& from, double lag_s, const Unrest& unrest) {
  Prediction result{from, Matrix::eye()};
  const glm::dmat3 turn = rotation_matrix(from.turn_rad_per_s * lag_s);
  result.state.pose.rotation = turn * from.pose.rotation;
  result.state.pose.translation_m += from.velocity_m_per_s * lag_s;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result.transition(i, j) = turn[j][i];
    result.transition(i, 6 + i) = lag_s;
    result.transition(3 + i, 9 + i) = lag_s;
  }
  result.state.covariance = result.transition * from.covariance * result.transition.t();
  for (int i = 0; i < 6; ++i) {
    const double density = i < 3 ? unrest.turn : unrest.shift;
    result.state.covariance(i, i) += density * lag_s * lag_s * lag_s / 3;
    result.state.covariance(i, 6 + i) += density * lag_s * lag_s / 2;
    result.state.covariance(6 + i, i) += density * lag_s * lag_s / 2;
    result.state.covariance(6 + i, 6 + i) += density * lag_s;
  }
  return result;
}

/// What leads from one state's mean to another's.
Vector difference(const State& to, const State& from) {
  const glm::dvec3 turn = rotation_vector(to.pose.rotation * glm::transpose(from.pose.rotation));
  const glm::dvec3 shift = to.pose.translation_m - from.pose.translation_m;
  const glm::dvec3 spin = to.turn_rad_per_s - from.turn_rad_per_s, speed = to.velocity_m_per_s - from.velocity_m_per_s;
  return {turn.x, turn.y, turn.z, shift.x, shift.y, shift.z, spin.x, spin.y, spin.z, speed.x, speed.y, speed.z};
}

void move(State& state, const Vector& by) {
  const auto part = [&](int at) { return glm::dvec3(by(at), by(at + 1), by(at + 2)); };
  state.pose.rotation = rotation_matrix(part(0)) * state.pose.rotation;
  state.pose.translation_m += part(3);
  state.turn_rad_per_s += part(6);
  state.velocity_m_per_s += part(9);
}

/// Kalman's update with a measured pose.
void update(State& state, const PoseCandidate& measured) {
  const cv::Matx66d noise(measured.covariance.data());
  const cv::Matx66d innovation = state.covariance.get_minor<6, 6>(0, 0) + noise;
  const cv::Matx<double, 12, 6> gain = state.covariance.get_minor<12, 6>(0, 0) * innovation.inv(cv::DECOMP_CHOLESKY);
  State seen = state;
  seen.pose = measured.camera_from_tag;
  const cv::Matx<double, 6, 1> residual = difference(seen, state).get_minor<6, 1>(0, 0);
  move(state, gain * residual);
  state.covariance -= gain * state.covariance.get_minor<6, 12>(0, 0);
  state.covariance = (state.covariance + state.covariance.t()) * 0.5;
}

SmoothedPose result_of(const State& state) {
  SmoothedPose result{state.pose, {}};
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) result.covariance[static_cast<std::size_t>(6 * i + j)] = state.covariance(i, j);
  return result;
}

/// A moment of the trajectory: a measurement, or a time that a pose is asked for, or both.
struct Moment {
  double time_s;
  const PoseCandidate* measured = nullptr;
  Unrest unrest;
  bool asked = false;
};

/// The unrest of the motion from one measurement to the next lies between theirs, whichever way time runs.
Unrest between(const Unrest& a, const Unrest& b) {
  return {std::sqrt(a.turn * b.turn), std::sqrt(a.shift * b.shift)};
}

std::vector<Moment> moments_of(std::span<const TimedCandidate> measured, std::span<const double> at_s) {
  const std::vector<Unrest> unrest = unrest_of(measured);
  std::vector<Moment> moments;
  std::size_t m = 0, a = 0;
  while (m < measured.size() || a < at_s.size()) {
    const bool take_measured = m < measured.size() && (a == at_s.size() || measured[m].time_s <= at_s[a]);
    const std::size_t last = m > 0 ? m - 1 : 0, next = std::min(m, measured.size() - 1);
    Moment moment{take_measured ? measured[m].time_s : at_s[a], nullptr, between(unrest[last], unrest[next]), false};
    if (take_measured) moment.measured = &measured[m++].pose;
    if (a < at_s.size() && at_s[a] == moment.time_s) {
      moment.asked = true;
      ++a;
    }
    moments.push_back(moment);
  }
  return moments;
}

}  // namespace

std::vector<SmoothedPose> smooth_trajectory(std::span<const TimedCandidate> measured, std::span<const double> at_s) {
  const std::vector<Moment> moments = moments_of(measured, at_s);
  std::vector<State> filtered;
  std::vector<Prediction> predicted(moments.size());
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const Moment& moment = moments[i];
    if (filtered.empty()) {
      filtered.push_back(first_state(moment.measured ? *moment.measured : measured[0].pose));
      continue;
    }
    predicted[i] = predict(filtered.back(), moment.time_s - moments[i - 1].time_s, moment.unrest);
    filtered.push_back(predicted[i].state);
    if (moment.measured) update(filtered.back(), *moment.measured);
  }
  State smoothed = filtered.back();
  std::vector<SmoothedPose> result;
  for (std::size_t i = moments.size(); i-- > 0;) {
    if (i + 1 < moments.size()) {
      State here = filtered[i];
      const Prediction& next = predicted[i + 1];
      const Matrix gain = here.covariance * next.transition.t() * next.state.covariance.inv(cv::DECOMP_CHOLESKY);
      move(here, gain * difference(smoothed, next.state));
      here.covariance += gain * (smoothed.covariance - next.state.covariance) * gain.t();
      smoothed = here;
    }
    if (moments[i].asked) result.push_back(result_of(smoothed));
  }
  std::reverse(result.begin(), result.end());
  return result;
}

}  // namespace catchlight::tracking
