// Smoothing on trajectories whose truth is known: nothing where measurements are sharp, averaging where the camera rests, no harm
// between.
#include "tracking/trajectory/smoothing.hpp"
#include "catchlight/rigid_transform.hpp"
#include "tests/tracking/trajectory/trajectory_fixture.hpp"
#include "tracking/observation.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace catchlight::tracking {
namespace {

using namespace path_test;

std::vector<double> times_of(const std::vector<TimedCandidate>& trajectory) {
  std::vector<double> times_s;
  for (const TimedCandidate& each : trajectory) times_s.push_back(each.time_s);
  return times_s;
}

std::vector<SmoothedPose> smoothed(const std::vector<TimedCandidate>& trajectory) {
  return smooth_trajectory(trajectory, times_of(trajectory));
}

/// `truth` of time, seen with noise at 30 frames a second.
template <class Truth>
std::vector<TimedCandidate> noisy(int frames, const Sigma& sigma, unsigned seed, Truth&& truth) {
  Noise noise(seed);
  std::vector<TimedCandidate> trajectory;
  for (int i = 0; i < frames; ++i) trajectory.push_back({i * kFrame_s, noise.measured(truth(i * kFrame_s), sigma)});
  return trajectory;
}

struct Rms {
  double turn_rad = 0, shift_m = 0;
};

/// The error over the frames of [begin, end); `pose_of(i)` is compared with the truth at frame i.
template <class Truth, class Poses>
Rms rms_error(int begin, int end, Truth&& truth, Poses&& pose_of) {
  Rms sum;
  for (int i = begin; i < end; ++i) {
    sum.turn_rad += std::pow(turn_between_rad(pose_of(i), truth(i * kFrame_s)), 2);
    sum.shift_m += std::pow(shift_between_m(pose_of(i), truth(i * kFrame_s)), 2);
  }
  return {std::sqrt(sum.turn_rad / (end - begin)), std::sqrt(sum.shift_m / (end - begin))};
}

void expect_steady(const std::vector<SmoothedPose>& poses, const std::vector<double>& times_s, double tolerance = 1e-6) {
  ASSERT_EQ(poses.size(), times_s.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT(turn_between_rad(poses[i].camera_from_tag, steady(times_s[i])), tolerance) << i;
    EXPECT_LT(shift_between_m(poses[i].camera_from_tag, steady(times_s[i])), tolerance) << i;
  }
}

TEST(TrajectorySmoothing, SteadyMotionComesOutUntouched) {
  for (const Sigma sigma : {Sigma{1e-4, 1e-5}, Sigma{1e-3, 1e-4}}) {
    std::vector<TimedCandidate> trajectory;
    for (int i = 0; i < 60; ++i) trajectory.push_back({i * kFrame_s, measured(steady(i * kFrame_s), sigma)});
    expect_steady(smoothed(trajectory), times_of(trajectory));
  }
}

TEST(TrajectorySmoothing, SteadyMotionOfAnUncertainTagComesOutToAThousandthOfThat) {
  // What is expected of its speed before the first frame, 3 rad/s, pulls a little.
  const Sigma vague{1e-2, 1e-3};
  std::vector<TimedCandidate> trajectory;
  for (int i = 0; i < 60; ++i) trajectory.push_back({i * kFrame_s, measured(steady(i * kFrame_s), vague)});
  expect_steady(smoothed(trajectory), times_of(trajectory), 1e-3 * vague.turn_rad);
}

TEST(TrajectorySmoothing, SteadyMotionAtAVariableFrameRateComesOutUntouched) {
  std::vector<TimedCandidate> trajectory;
  double time_s = 0;
  for (int i = 0; i < 60; ++i) {
    time_s += std::array{0.008, 0.04, 0.017, 0.1}[static_cast<std::size_t>(i * 7 % 4)];
    trajectory.push_back({time_s, measured(steady(time_s))});
  }
  expect_steady(smoothed(trajectory), times_of(trajectory));
}

TEST(TrajectorySmoothing, AGapIsBridgedOnTheTrueLine) {
  std::vector<TimedCandidate> trajectory;
  std::vector<double> times_s;
  for (int i = 0; i < 40; ++i) {
    times_s.push_back(i * kFrame_s);
    if (i < 15 || i >= 21) trajectory.push_back({i * kFrame_s, measured(steady(i * kFrame_s))});
  }
  expect_steady(smooth_trajectory(trajectory, times_s), times_s);
}

TEST(TrajectorySmoothing, AfterTheLastMeasurementTheMotionGoesOn) {
  std::vector<TimedCandidate> trajectory;
  for (int i = 0; i < 30; ++i) trajectory.push_back({i * kFrame_s, measured(steady(i * kFrame_s))});
  const std::vector<double> later_s{30 * kFrame_s, 31 * kFrame_s, 35 * kFrame_s};
  const auto poses = smooth_trajectory(trajectory, later_s);
  expect_steady(poses, later_s, 1e-5);
  EXPECT_GT(poses[2].covariance[0], poses[0].covariance[0]) << "and is less and less certain";
}

TEST(TrajectorySmoothing, OneMeasurementIsItself) {
  const PoseCandidate only = measured(steady(0));
  const std::vector<double> times_s{0, kFrame_s};
  const auto poses = smooth_trajectory(std::vector<TimedCandidate>{{0, only}}, times_s);
  ASSERT_EQ(poses.size(), 2u);
  for (const SmoothedPose& pose : poses) {
    EXPECT_LT(turn_between_rad(pose.camera_from_tag, steady(0)), 1e-12);
    EXPECT_LT(shift_between_m(pose.camera_from_tag, steady(0)), 1e-12);
  }
  EXPECT_NEAR(poses[0].covariance[0], only.covariance[0], 1e-12);
}

TEST(TrajectorySmoothing, TwoMeasurementsAreThemselves) {
  // Any two poses lie on a steady trajectory.
  std::vector<TimedCandidate> trajectory{{0, measured(steady(0))}, {kFrame_s, measured(steady(3 * kFrame_s))}};
  const auto poses = smoothed(trajectory);
  EXPECT_LT(shift_between_m(poses[0].camera_from_tag, steady(0)), 1e-6);
  EXPECT_LT(shift_between_m(poses[1].camera_from_tag, steady(3 * kFrame_s)), 1e-6);
  EXPECT_LT(turn_between_rad(poses[1].camera_from_tag, steady(3 * kFrame_s)), 0.05 * Sigma().turn_rad);
}

TEST(TrajectorySmoothing, RepeatedTimesAreFiniteAndAveraged) {
  // A container that rounds its times to whole frames of another rate: every third frame has the time of the one before.
  Noise noise(5);
  const RigidTransform truth = steady(0);
  std::vector<TimedCandidate> trajectory;
  for (int i = 0; i < 60; ++i) trajectory.push_back({(i - (i % 3 == 2)) * kFrame_s, noise.measured(truth, {})});
  const auto poses = smoothed(trajectory);
  ASSERT_EQ(poses.size(), trajectory.size());
  const auto at_rest = [&](double) { return truth; };
  const Rms raw = rms_error(0, 60, at_rest, [&](int i) { return trajectory[static_cast<std::size_t>(i)].pose.camera_from_tag; });
  const Rms now = rms_error(0, 60, at_rest, [&](int i) { return poses[static_cast<std::size_t>(i)].camera_from_tag; });
  EXPECT_LT(now.turn_rad, raw.turn_rad / 2);
  EXPECT_LT(now.shift_m, raw.shift_m / 2);
}

TEST(TrajectorySmoothing, ATagAtRestStopsJittering) {
  const auto at_rest = [](double) { return steady(0); };
  double turn = 0, shift = 0;
  constexpr int kTrajectories = 10;
  for (unsigned seed = 0; seed < kTrajectories; ++seed) {
    const auto trajectory = noisy(90, {}, seed, at_rest);
    const auto poses = smoothed(trajectory);
    const Rms raw =
        rms_error(15, 75, at_rest, [&](int i) { return trajectory[static_cast<std::size_t>(i)].pose.camera_from_tag; });
    const Rms now = rms_error(15, 75, at_rest, [&](int i) { return poses[static_cast<std::size_t>(i)].camera_from_tag; });
    turn += now.turn_rad / raw.turn_rad / kTrajectories;
    shift += now.shift_m / raw.shift_m / kTrajectories;
  }
  // Averaging 90 frames leaves 1/sqrt(90) = 0.11 of it; who must first find out that the tag rests may leave twice that.
  EXPECT_LT(turn, 2 / std::sqrt(90.0));
  EXPECT_LT(shift, 2 / std::sqrt(90.0));
}

TEST(TrajectorySmoothing, AJoltMeasuredSharplyStays) {
  const Sigma sharp{1e-4, 1e-5};
  const auto jolted = [](double time_s) {
    RigidTransform pose = steady(0);
    if (time_s < 0.999) return pose;  // 3° and 1 cm within a frame
    return RigidTransform{rotation_matrix({0.05, 0, 0}) * pose.rotation, pose.translation_m + glm::dvec3(0, 0.01, 0)};
  };
  std::vector<TimedCandidate> trajectory;
  for (int i = 0; i < 60; ++i) trajectory.push_back({i * kFrame_s, measured(jolted(i * kFrame_s), sharp)});
  const auto poses = smoothed(trajectory);
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    EXPECT_LT(turn_between_rad(poses[i].camera_from_tag, trajectory[i].pose.camera_from_tag), 1.5 * sharp.turn_rad) << i;
    EXPECT_LT(shift_between_m(poses[i].camera_from_tag, trajectory[i].pose.camera_from_tag), 1.5 * sharp.shift_m) << i;
  }
}

TEST(TrajectorySmoothing, TurningTheCameraTurnsTheTrajectory) {
  // Noise that differs by axis, so that the covariances have to turn too.
  const RigidTransform turned_from_camera{rotation_matrix({0.7, -1.1, 0.4}), {}};
  const auto turned_covariance = [&](const PoseCovariance& covariance) {
    PoseCovariance result{};
    for (std::size_t b = 0; b < 2; ++b) {
      glm::dmat3 block(0.0);
      for (std::size_t i = 0; i < 3; ++i) block[static_cast<int>(i)][static_cast<int>(i)] = covariance[7 * (3 * b + i)];
      block = turned_from_camera.rotation * block * glm::transpose(turned_from_camera.rotation);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) result[6 * (3 * b + i) + 3 * b + j] = block[static_cast<int>(j)][static_cast<int>(i)];
    }
    return result;
  };
  auto trajectory = noisy(40, {3e-3, 3e-4}, 2, steady);
  for (TimedCandidate& each : trajectory) each.pose.covariance[14] *= 9, each.pose.covariance[35] *= 25;
  auto turned = trajectory;
  for (TimedCandidate& each : turned)
    each.pose = {turned_from_camera * each.pose.camera_from_tag, turned_covariance(each.pose.covariance), 0};
  const auto poses = smoothed(trajectory), turned_poses = smoothed(turned);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const RigidTransform expected = turned_from_camera * poses[i].camera_from_tag;
    EXPECT_LT(turn_between_rad(turned_poses[i].camera_from_tag, expected), 1e-8) << i;
    EXPECT_LT(shift_between_m(turned_poses[i].camera_from_tag, expected), 1e-9) << i;
  }
}

TEST(TrajectorySmoothing, TimeRunningBackwardGivesTheSameTrajectoryBackward) {
  const Sigma sigma{3e-3, 3e-4};
  const auto trajectory = noisy(60, sigma, 3, [](double) { return steady(0); });
  std::vector<TimedCandidate> backward(trajectory.rbegin(), trajectory.rend());
  for (TimedCandidate& each : backward) each.time_s = -each.time_s;
  const auto poses = smoothed(trajectory), backward_poses = smoothed(backward);
  double worst_turn = 0, worst_shift = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const RigidTransform& other = backward_poses[poses.size() - 1 - i].camera_from_tag;
    worst_turn = std::max(worst_turn, turn_between_rad(poses[i].camera_from_tag, other));
    worst_shift = std::max(worst_shift, shift_between_m(poses[i].camera_from_tag, other));
  }
  EXPECT_LT(worst_turn, 0.1 * sigma.turn_rad);
  EXPECT_LT(worst_shift, 0.1 * sigma.shift_m);
}

/// Slow swings, as a hand makes them.
RigidTransform swinging(double time_s) {
  const glm::dvec3 wave(std::sin(2.1 * time_s), std::sin(3.7 * time_s + 1), std::sin(5.3 * time_s + 2));
  return {rotation_matrix(0.3 * wave) * steady(0).rotation, steady(0).translation_m + 0.05 * wave};
}

/// A camera without inertia, drawn once: each frame a step of 2 mm and 10 mrad per axis from the last.
RigidTransform stumbling(double time_s) {
  static const std::vector<RigidTransform> poses = [] {
    Noise noise(99);
    std::vector<RigidTransform> walk{steady(0)};
    for (int i = 1; i < 240; ++i)
      walk.push_back(
          {rotation_matrix(noise.vector(0.01)) * walk.back().rotation, walk.back().translation_m + noise.vector(0.002)});
    return walk;
  }();
  return poses.at(static_cast<std::size_t>(std::lround(time_s / kFrame_s)));
}

struct Trajectory {
  const char* name;
  RigidTransform (*truth)(double);
  double most;  ///< largest share of the raw error that may be left
};

class TrajectorySmoothingOf : public ::testing::TestWithParam<Trajectory> {};

TEST_P(TrajectorySmoothingOf, NoiseOfAnySizeIsNotMadeWorse) {
  for (const double size : {0.03, 0.3, 1.0, 3.0, 10.0}) {
    const Sigma sigma{1e-3 * size, 2e-4 * size};
    const auto trajectory = noisy(240, sigma, 17, GetParam().truth);
    const auto poses = smoothed(trajectory);
    const auto raw =
        rms_error(0, 240, GetParam().truth, [&](int i) { return trajectory[static_cast<std::size_t>(i)].pose.camera_from_tag; });
    const auto now =
        rms_error(0, 240, GetParam().truth, [&](int i) { return poses[static_cast<std::size_t>(i)].camera_from_tag; });
    EXPECT_LT(now.turn_rad, GetParam().most * raw.turn_rad) << "noise of " << sigma.turn_rad << " rad";
    EXPECT_LT(now.shift_m, GetParam().most * raw.shift_m) << "noise of " << sigma.shift_m << " m";
  }
}

/// A trajectory of steps is rougher than the white accelerations that stand for it: between noise far below the steps (left
/// alone) and far above them (averaged), a few hundredths of the noise are added.
INSTANTIATE_TEST_SUITE_P(Trajectories, TrajectorySmoothingOf,
                         ::testing::Values(Trajectory{"Steady", steady, 1}, Trajectory{"Swinging", swinging, 1},
                                           Trajectory{"Stumbling", stumbling, 1.05}),
                         [](const auto& trajectory) { return std::string(trajectory.param.name); });

}  // namespace
}  // namespace catchlight::tracking
