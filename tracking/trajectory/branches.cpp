#include "tracking/trajectory/branches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tracking/trajectory/steadiness.hpp"

namespace catchlight::tracking {
namespace {

/// Hands turn a camera at up to about this, rad/s².
constexpr double kTurnAcceleration = 12;
/// No single frame, and no single jolt, decides a trajectory.
constexpr double kMaxEvidence = 6, kMaxSurprise = 10;
constexpr double kNever = -std::numeric_limits<double>::infinity();

/// Log-probabilities of a pair of candidates, of the frame before and of this one.
using Pairs = std::array<std::array<double, 2>, 2>;

Pairs all_never() {
  return {{{kNever, kNever}, {kNever, kNever}}};
}

double log_sum(double a, double b) {
  const double larger = std::max(a, b);
  return larger == kNever ? kNever : larger + std::log(std::exp(a - larger) + std::exp(b - larger));
}

/// What a frame says for one of its candidates, 0 for the best.
double evidence(const TrajectoryFrame& frame, std::size_t candidate) {
  double best = kNever;
  for (const PoseCandidate& each : frame.candidates) best = std::max(best, each.log_likelihood);
  return std::max(frame.candidates[candidate].log_likelihood - best, -kMaxEvidence);
}

/// How likely a third orientation is after two, up to a constant.
double continuity(const TrajectoryFrame& first, std::size_t a, const TrajectoryFrame& second, std::size_t b,
                  const TrajectoryFrame& third, std::size_t c) {
  const Unsteadiness turn = unsteady_turn({first.time_s, &first.candidates[a]}, {second.time_s, &second.candidates[b]},
                                          {third.time_s, &third.candidates[c]});
  const double lag_s = third.time_s - second.time_s;
  const double jolt_rad = kTurnAcceleration * lag_s * std::max(lag_s, second.time_s - first.time_s);
  return std::max(log_density(turn, jolt_rad * jolt_rad) - log_density({{}, turn.covariance}, jolt_rad * jolt_rad),
                  -kMaxSurprise);
}

/// Two orientations without a third before them: nearer is likelier.
double closeness(const TrajectoryFrame& first, std::size_t a, const TrajectoryFrame& second, std::size_t b) {
  const double lag_s = std::max(second.time_s - first.time_s, 1e-3);
  const Unsteadiness turn = plain_turn(first.candidates[a], second.candidates[b]);
  constexpr double kTurnSpeed = 1.5;  // rad/s
  const double usual = kTurnSpeed * kTurnSpeed * lag_s * lag_s;
  return std::max(log_density(turn, usual) - log_density({{}, turn.covariance}, usual), -kMaxSurprise);
}

class Chain {
 public:
  explicit Chain(std::span<const TrajectoryFrame* const> frames) : frames_(frames) {
    for (std::size_t i = 1; i < frames.size(); ++i) steps_.push_back(step(i));
  }

  std::vector<Branch> solve() const {
    const std::vector<Pairs> forward = pass(true), backward = pass_back(), best = pass(false);
    std::vector<Branch> branches(frames_.size());
    // The likeliest sequence, from its end; then each frame's share of all the others.
    std::size_t now = 0, before = 0;
    double likeliest = kNever;
    for (std::size_t a = 0; a < 2; ++a)
      for (std::size_t b = 0; b < 2; ++b)
        if (best.back()[a][b] > likeliest) likeliest = best.back()[a][b], before = a, now = b;
    for (std::size_t i = frames_.size(); i-- > 1;) {
      branches[i].candidate = now;
      branches[i - 1].candidate = before;
      if (i < 2) break;
      std::size_t earlier = 0;
      double value = kNever;
      for (std::size_t z = 0; z < 2; ++z)
        if (const double v = best[i - 2][z][before] + steps_[i - 1][z][before][now]; v > value) value = v, earlier = z;
      now = before;
      before = earlier;
    }
    for (std::size_t i = 1; i < frames_.size(); ++i) {
      std::array<double, 2> here{kNever, kNever}, last{kNever, kNever};
      for (std::size_t a = 0; a < 2; ++a)
        for (std::size_t b = 0; b < 2; ++b) {
          const double total = forward[i - 1][a][b] + backward[i - 1][a][b];
          here[b] = log_sum(here[b], total);
          last[a] = log_sum(last[a], total);
        }
      branches[i].ambiguity = other_share(here, branches[i].candidate);
      if (i == 1) branches[0].ambiguity = other_share(last, branches[0].candidate);
    }
    return branches;
  }

 private:
  /// [before last][last][this] of the step into frame i; the first step has no frame before last.
  using Step = std::array<Pairs, 2>;

  static double other_share(const std::array<double, 2>& values, std::size_t chosen) {
    const double all = log_sum(values[0], values[1]);
    return values[1 - chosen] == kNever ? 0 : std::exp(values[1 - chosen] - all);
  }

  Step step(std::size_t i) const {
    Step result{all_never(), all_never()};
    const TrajectoryFrame &last = *frames_[i - 1], &here = *frames_[i];
    for (std::size_t c = 0; c < here.candidates.size(); ++c)
      for (std::size_t b = 0; b < last.candidates.size(); ++b) {
        if (i == 1) {
          for (std::size_t z = 0; z < 2; ++z)
            result[z][b][c] = evidence(last, b) + evidence(here, c) + closeness(last, b, here, c);
          continue;
        }
        const TrajectoryFrame& first = *frames_[i - 2];
        for (std::size_t a = 0; a < first.candidates.size(); ++a)
          result[a][b][c] = evidence(here, c) + continuity(first, a, last, b, here, c);
      }
    return result;
  }

  /// Entry i: of the pair of frames i and i + 1, over everything up to there; summed, or the best alone.
  std::vector<Pairs> pass(bool sum) const {
    std::vector<Pairs> result{steps_[0][0]};
    for (std::size_t i = 1; i < steps_.size(); ++i) {
      Pairs next = all_never();
      for (std::size_t a = 0; a < 2; ++a)
        for (std::size_t b = 0; b < 2; ++b)
          for (std::size_t c = 0; c < 2; ++c) {
            const double value = result.back()[a][b] + steps_[i][a][b][c];
            next[b][c] = sum ? log_sum(next[b][c], value) : std::max(next[b][c], value);
          }
      result.push_back(next);
    }
    return result;
  }

  /// Entry i: of everything after the pair of frames i and i + 1.
  std::vector<Pairs> pass_back() const {
    std::vector<Pairs> result(steps_.size());
    result.back() = {};
    for (std::size_t i = steps_.size() - 1; i-- > 0;) {
      result[i] = all_never();
      for (std::size_t a = 0; a < 2; ++a)
        for (std::size_t b = 0; b < 2; ++b)
          for (std::size_t c = 0; c < 2; ++c)
            result[i][a][b] = log_sum(result[i][a][b], result[i + 1][b][c] + steps_[i + 1][a][b][c]);
    }
    return result;
  }

  std::span<const TrajectoryFrame* const> frames_;
  std::vector<Step> steps_;
};

}  // namespace

std::vector<Branch> choose_branches(std::span<const TrajectoryFrame* const> frames) {
  if (frames.empty()) return {};
  if (frames.size() > 1) return Chain(frames).solve();
  Branch only;
  const TrajectoryFrame& frame = *frames[0];
  if (frame.candidates.size() < 2) return {only};
  const double odds = frame.candidates[1].log_likelihood - frame.candidates[0].log_likelihood;
  only.candidate = odds > 0 ? 1 : 0;
  only.ambiguity = 1 / (1 + std::exp(std::abs(odds)));
  return {only};
}

}  // namespace catchlight::tracking
