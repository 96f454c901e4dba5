// Measured trajectories made to order, for the tests of what is solved over time.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "catchlight/rigid_transform.hpp"
#include "catchlight/rotation.hpp"
#include "tests/support/pose_error.hpp"
#include "tests/support/synthetic_tag.hpp"
#include "tracking/trajectory/solver.hpp"

namespace catchlight::tracking::path_test {

inline constexpr double kFrame_s = 1.0 / 30;

/// Standard deviations per axis, independent of each other.
struct Sigma {
  double turn_rad = 1e-3, shift_m = 1e-4;
};

inline PoseCandidate measured(const RigidTransform& camera_from_tag, const Sigma& sigma = {}, double log_likelihood = 0) {
  PoseCandidate candidate{camera_from_tag, {}, log_likelihood};
  for (std::size_t i = 0; i < 6; ++i) {
    const double each = i < 3 ? sigma.turn_rad : sigma.shift_m;
    candidate.covariance[7 * i] = each * each;
  }
  return candidate;
}

/// With normal errors as large as its covariance says.
class Noise {
 public:
  explicit Noise(unsigned seed) : random_(seed) {}

  glm::dvec3 vector(double sigma) { return sigma * glm::dvec3(normal_(random_), normal_(random_), normal_(random_)); }

  PoseCandidate measured(const RigidTransform& truth, const Sigma& sigma) {
    const RigidTransform seen{rotation_matrix(vector(sigma.turn_rad)) * truth.rotation,
                              truth.translation_m + vector(sigma.shift_m)};
    return path_test::measured(seen, sigma);
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

/// Steady: half a metre away, turning and moving at constant rates about no special axis.
inline RigidTransform steady(double time_s) {
  const RigidTransform start = tag_pose(plain_camera(), {300, 250}, 0.5, {20, -30, 40});
  return {rotation_matrix(glm::dvec3(0.5, -1.2, 2.0) * time_s) * start.rotation,
          start.translation_m + glm::dvec3(0.3, -0.2, 0.1) * time_s};
}

/// Tilted about the camera's y axis. Seen so, -tilt explains the picture almost as well.
inline RigidTransform tilted(double tilt_deg) {
  return tag_pose(plain_camera(), {319.5, 239.5}, 0.8, {0, tilt_deg, 0});
}

/// Both poses of a frame, the true one first; `favour` is by how much the pixels prefer it, in log-likelihood.
inline TrajectoryFrame ambiguous(double time_s, double true_tilt_deg, double favour) {
  return {time_s, {measured(tilted(true_tilt_deg), {0.01, 1e-4}, 0), measured(tilted(-true_tilt_deg), {0.01, 1e-4}, -favour)}};
}

inline double shift_between_m(const RigidTransform& a, const RigidTransform& b) {
  return glm::distance(a.translation_m, b.translation_m);
}

inline double turn_between_rad(const RigidTransform& a, const RigidTransform& b) {
  return turn_between_deg(a, b) * M_PI / 180;
}

}  // namespace catchlight::tracking::path_test
