// Deviations from steady motion, on motion whose deviation is known.
#include "tracking/trajectory/steadiness.hpp"
#include "catchlight/rigid_transform.hpp"
#include "tests/tracking/trajectory/trajectory_fixture.hpp"
#include "tracking/observation.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace catchlight::tracking {
namespace {

using namespace path_test;

/// Three moments, unevenly spaced unless said.
struct Three {
  explicit Three(double second_s = 0.1, double third_s = 0.17) : times_s{0, second_s, third_s} {
    for (int i = 0; i < 3; ++i) poses[i] = measured(steady(times_s[i]), {1e-3 * (i + 1), 1e-4 * (i + 1)});
  }
  TimedPose at(int i) const { return {times_s[i], &poses[i]}; }
  Unsteadiness turn() const { return unsteady_turn(at(0), at(1), at(2)); }
  Unsteadiness shift() const { return unsteady_shift(at(0), at(1), at(2)); }

  double times_s[3];
  PoseCandidate poses[3];
};

TEST(Steadiness, SteadyMotionDeviatesByNothingWhateverTheIntervals) {
  for (const double third_s : {0.11, 0.17, 0.2, 0.5}) {
    const Three three(0.1, third_s);
    EXPECT_LT(glm::length(three.turn().deviation), 1e-12);
    EXPECT_LT(glm::length(three.shift().deviation), 1e-12);
  }
}

TEST(Steadiness, WhatIsAddedToTheThirdIsTheDeviation) {
  Three three;
  const glm::dvec3 turn(0.02, -0.01, 0.03), shift(0.001, 0.002, -0.003);
  RigidTransform& third = three.poses[2].camera_from_tag;
  third = {rotation_matrix(turn) * third.rotation, third.translation_m + shift};
  EXPECT_LT(glm::distance(three.turn().deviation, turn), 1e-12);
  EXPECT_LT(glm::distance(three.shift().deviation, shift), 1e-12);
}

TEST(Steadiness, ErrorsOfTheFirstTwoAreLeveredByTheIntervals) {
  // Third from first and second: x3 - (1 + r) x2 + r x1, r = 0.07 / 0.1.
  const Three three;
  const double r = 0.7;
  const double in_units = 9 + (1 + r) * (1 + r) * 4 + r * r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(three.shift().covariance[i][j], i == j ? in_units * 1e-8 : 0, 1e-15);
      EXPECT_NEAR(three.turn().covariance[i][j], i == j ? in_units * 1e-6 : 0, 1e-13);
    }
}

TEST(Steadiness, ARepeatedTimeIsFinite) {
  for (const Three& three : {Three(0.0, 0.1), Three(0.1, 0.1), Three(0.0, 0.0)})
    for (const Unsteadiness& unsteadiness : {three.turn(), three.shift()}) {
      EXPECT_TRUE(std::isfinite(glm::length(unsteadiness.deviation)));
      EXPECT_TRUE(std::isfinite(log_density(unsteadiness, 1e-6)));
    }
}

TEST(Steadiness, TurningTheCameraTurnsTheDeviationWithIt) {
  Three three;
  RigidTransform& third = three.poses[2].camera_from_tag;
  third.rotation = rotation_matrix({0.02, -0.01, 0.03}) * third.rotation;
  third.translation_m += glm::dvec3(0.001, 0.002, -0.003);
  const glm::dvec3 turn = three.turn().deviation, shift = three.shift().deviation;
  const glm::dmat3 turned_from_camera = rotation_matrix({0.7, -1.1, 0.4});
  for (PoseCandidate& pose : three.poses) pose.camera_from_tag = RigidTransform{turned_from_camera, {}} * pose.camera_from_tag;
  EXPECT_LT(glm::distance(three.turn().deviation, turned_from_camera * turn), 1e-12);
  EXPECT_LT(glm::distance(three.shift().deviation, turned_from_camera * shift), 1e-12);
}

TEST(Steadiness, APlainTurnIsTheTurnAndBothErrors) {
  const PoseCandidate first = measured(steady(0), {1e-3, 1}), second = measured(steady(0.1), {2e-3, 1});
  const Unsteadiness turn = plain_turn(first, second);
  EXPECT_LT(glm::distance(turn.deviation, glm::dvec3(0.05, -0.12, 0.2)), 1e-12);
  EXPECT_NEAR(turn.covariance[1][1], 5e-6, 1e-15);
}

TEST(Steadiness, TheLogDensityIsTheNormalOneWithoutItsConstant) {
  // Axis by axis: the covariance is diagonal.
  const Unsteadiness unsteadiness{{0.1, -0.2, 0.05}, glm::dmat3{{0.01, 0, 0}, {0, 0.02, 0}, {0, 0, 0.0025}}};
  double expected = 0;
  for (int i = 0; i < 3; ++i) {
    const double variance = unsteadiness.covariance[i][i] + 0.003, x = unsteadiness.deviation[i];
    expected += -x * x / (2 * variance) - std::log(variance) / 2;
  }
  EXPECT_NEAR(log_density(unsteadiness, 0.003), expected, 1e-12);
}

TEST(Steadiness, ADeviationIsLikeliestUnderItsOwnVariance) {
  // The maximum over the variance lies at |deviation|² / 3 where nothing else is uncertain.
  const Unsteadiness unsteadiness{{0.1, -0.2, 0.05}, glm::dmat3(0.0)};
  const double own = glm::dot(unsteadiness.deviation, unsteadiness.deviation) / 3;
  EXPECT_GT(log_density(unsteadiness, own), log_density(unsteadiness, 0.9 * own));
  EXPECT_GT(log_density(unsteadiness, own), log_density(unsteadiness, 1.1 * own));
}

}  // namespace
}  // namespace catchlight::tracking
