// The choice between two planar poses, on trajectories whose truth is known.
#include "tracking/pose/pose_memory.hpp"
#include "catchlight/rigid_transform.hpp"
#include "tests/support/pose_error.hpp"
#include "tests/support/synthetic_tag.hpp"
#include "tracking/observation.hpp"
#include "tracking/pose/corner_noise.hpp"
#include "tracking/pose/planar_pose.hpp"

#include <gtest/gtest.h>

#include <random>

namespace catchlight::tracking {
namespace {

constexpr double kFrame_s = 1.0 / 30;

std::vector<PoseHypothesis> seen(const RigidTransform& truth, double noise_px, std::mt19937& random) {
  std::normal_distribution<double> normal;
  SyntheticTag tag;
  tag.camera_from_tag = truth;
  auto corners_px = true_corners_px(plain_camera(), tag);
  for (glm::dvec2& corner : corners_px) corner += noise_px * glm::dvec2(normal(random), normal(random));
  return planar_poses(plain_camera(), corners_px, tag.target.size_m);
}

bool is_wrong(std::span<const PoseCandidate> poses, std::size_t chosen, const RigidTransform& truth) {
  return turn_between_deg(poses[chosen].camera_from_tag, truth) > turn_between_deg(poses[1 - chosen].camera_from_tag, truth);
}

/// A hand-held trajectory around a tag that is 32 px large and nearly frontal: tilts wander as sums of slow waves.
class WanderingTrajectory {
 public:
  explicit WanderingTrajectory(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0, 1);
    for (Wave& wave : waves_) wave = {6 + 8 * unit(random), 0.15 + 0.45 * unit(random), 2 * M_PI * unit(random)};
  }
  RigidTransform at(double time_s) const {
    const auto wave = [&](int i) { return waves_[i].size_deg * std::sin(2 * M_PI * waves_[i].hertz * time_s + waves_[i].phase); };
    return tag_pose(plain_camera(), {320 + 8 * wave(4), 240 + 8 * wave(5)}, 1.5, {wave(0) + wave(1), wave(2) + wave(3), wave(6)});
  }

 private:
  struct Wave {
    double size_deg, hertz, phase;
  };
  std::array<Wave, 7> waves_;
};

struct WrongShares {
  double alone = 0, with_memory = 0;
};

/// The share of frames in which the false pose is taken, among those whose two poses are further apart than their noise.
WrongShares wrong_shares(double noise_px) {
  std::mt19937 random(7);
  int ambiguous = 0, wrong_alone = 0, wrong_with_memory = 0;
  for (int path_number = 0; path_number < 100; ++path_number) {
    const WanderingTrajectory trajectory(random);
    PoseMemory memory;
    CornerNoise corner_noise;
    for (int frame = 0; frame < 60; ++frame) {
      const double time_s = frame * kFrame_s;
      const RigidTransform truth = trajectory.at(time_s);
      const auto poses = corner_noise.candidates(plain_camera(), seen(truth, noise_px, random), SyntheticTag().target.size_m);
      if (poses.empty()) continue;
      const std::size_t chosen = memory.choose(poses, time_s);
      if (poses.size() < 2 || turn_between_deg(poses[0].camera_from_tag, poses[1].camera_from_tag) < 10) continue;
      ++ambiguous;
      wrong_alone += is_wrong(poses, 0, truth);
      wrong_with_memory += is_wrong(poses, chosen, truth);
    }
  }
  const WrongShares shares{static_cast<double>(wrong_alone) / ambiguous, static_cast<double>(wrong_with_memory) / ambiguous};
  std::cout << "noise " << noise_px << " px: wrong in " << 100 * shares.alone << " % of " << ambiguous << " frames alone, in "
            << 100 * shares.with_memory << " % with memory\n";
  return shares;
}

TEST(PoseMemory, OnAHundredTrajectoriesOfASmallNearFrontalTagItErrsAQuarterAsOften) {
  const WrongShares shares = wrong_shares(0.1);
  EXPECT_GT(shares.alone, 0.03) << "the trajectories are too easy to tell anything";
  EXPECT_LT(shares.with_memory, shares.alone / 4);
}

TEST(PoseMemory, WithTwiceTheNoiseItErrsAThirdAsOften) {
  // Trajectories of two seconds: what remains is mostly their first frames, before evidence has added up.
  const WrongShares shares = wrong_shares(0.2);
  EXPECT_LT(shares.with_memory, shares.alone / 3);
}

RigidTransform tilted(double tilt_deg) {
  return tag_pose(plain_camera(), {319.5, 239.5}, 0.8, {0, tilt_deg, 0});
}

/// A pose whose corners leave `rms_px` where the noise is 0.05 px per axis.
PoseCandidate fitting(double tilt_deg, double rms_px) {
  return {tilted(tilt_deg), {}, -2 * rms_px * rms_px / (0.05 * 0.05)};
}

/// Candidates with errors made to order, the true one first.
std::vector<PoseCandidate> made(double tilt_deg, double true_rms_px, double false_rms_px) {
  return {fitting(tilt_deg, true_rms_px), fitting(-tilt_deg, false_rms_px)};
}

TEST(PoseMemory, FirstFrameTakesTheBetterFit) {
  EXPECT_EQ(PoseMemory().choose(made(30, 0.05, 0.4), 0), 0u);
  EXPECT_EQ(PoseMemory().choose(made(30, 0.4, 0.05), 0), 1u);
}

TEST(PoseMemory, OneNoisyFrameDoesNotTurnTheTagOver) {
  PoseMemory memory;
  for (int frame = 0; frame < 10; ++frame) EXPECT_EQ(memory.choose(made(20, 0.05, 0.25), frame * kFrame_s), 0u);
  EXPECT_EQ(memory.choose(made(20, 0.12, 0.08), 10 * kFrame_s), 0u);
  EXPECT_EQ(memory.choose(made(20, 0.05, 0.25), 11 * kFrame_s), 0u);
}

TEST(PoseMemory, AWrongFirstChoiceIsCorrected) {
  PoseMemory memory;
  EXPECT_EQ(memory.choose(made(25, 0.2, 0.1), 0), 1u) << "the first frame misleads";
  int frames_until_right = 0;
  while (frames_until_right < 100 && memory.choose(made(25, 0.08, 0.16), ++frames_until_right * kFrame_s) != 0u) continue;
  EXPECT_LE(frames_until_right, 10);
}

TEST(PoseMemory, HypothesesAreFollowedWhicheverComesFirst) {
  // planar_poses() sorts by error, so the true one changes its place: the choice has to follow the pose, not the index.
  PoseMemory memory;
  memory.choose(made(20, 0.05, 0.3), 0);
  const std::vector<PoseCandidate> swapped{fitting(-20, 0.08), fitting(20, 0.09)};
  EXPECT_EQ(memory.choose(swapped, kFrame_s), 1u);
}

TEST(PoseMemory, FollowsTheMotionThroughTheFrontalView) {
  // Tilting from +30° through 0° to −30° at 60°/s, both poses fit alike after the start: only the motion tells them apart.
  PoseMemory memory;
  int wrong = 0;
  for (int frame = 0; frame <= 30; ++frame) {
    const double tilt_deg = 30 - 2.0 * frame;
    const double false_rms_px = frame < 5 ? 0.4 : 0.05;
    const std::size_t chosen = memory.choose(made(tilt_deg, 0.05, false_rms_px), frame * kFrame_s);
    wrong += chosen != 0 && std::abs(tilt_deg) > 6;
  }
  EXPECT_EQ(wrong, 0);
}

TEST(PoseMemory, PredictsSteadyMotion) {
  PoseMemory memory;
  EXPECT_FALSE(memory.predict(0));
  for (int frame = 0; frame < 20; ++frame) {
    std::vector<PoseCandidate> one{fitting(frame, 0.05)};
    one[0].camera_from_tag.translation_m.x = 0.01 * frame;
    memory.choose(one, frame * kFrame_s);
  }
  const auto predicted = memory.predict(22 * kFrame_s);
  ASSERT_TRUE(predicted);
  EXPECT_NEAR(predicted->translation_m.x, 0.22, 1e-3);
  EXPECT_LT(turn_between_deg(*predicted, tilted(22)), 0.1);
}

TEST(PoseMemory, StandsStillAfterASingleFrame) {
  PoseMemory memory;
  memory.choose(made(30, 0.05, 0.4), 1.0);
  EXPECT_LT(turn_between_deg(*memory.predict(1.5), tilted(30)), 1e-9);
  memory.forget();
  EXPECT_FALSE(memory.predict(1.5));
}

TEST(PoseMemory, RepeatedTimesDoNotDivideByZero) {
  PoseMemory memory;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(memory.choose(made(30, 0.05, 0.4), 1.0), 0u);
  EXPECT_TRUE(std::isfinite(memory.predict(2.0)->translation_m.z));
}

}  // namespace
}  // namespace catchlight::tracking
