// The choice between two planar poses over a trajectory, with evidence made to order. The true candidate comes first unless said.
#include "tracking/trajectory/branches.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/tracking/trajectory/trajectory_fixture.hpp"

namespace catchlight::tracking {
namespace {

using namespace path_test;

std::vector<Branch> chosen(const std::vector<TrajectoryFrame>& frames) {
  std::vector<const TrajectoryFrame*> pointers;
  for (const TrajectoryFrame& frame : frames) pointers.push_back(&frame);
  return choose_branches(pointers);
}

std::vector<std::size_t> candidates_of(const std::vector<Branch>& branches) {
  std::vector<std::size_t> candidates;
  for (const Branch& branch : branches) candidates.push_back(branch.candidate);
  return candidates;
}

/// Frames at 30 a second; `tilt_deg` and `favour` are functions of the frame's number.
template <class Tilt, class Favour>
std::vector<TrajectoryFrame> trajectory(int frames, Tilt&& tilt_deg, Favour&& favour) {
  std::vector<TrajectoryFrame> result;
  for (int i = 0; i < frames; ++i) result.push_back(ambiguous(i * kFrame_s, tilt_deg(i), favour(i)));
  return result;
}

double resting(int) {
  return 20;
}

TEST(TrajectoryBranches, AnEmptyTrajectoryHasNone) {
  EXPECT_TRUE(choose_branches({}).empty());
}

TEST(TrajectoryBranches, ASingleFrameTakesTheLikelierAndDoubtsAsItsPixelsDo) {
  const Branch right = chosen({ambiguous(0, 20, 2)})[0], other = chosen({ambiguous(0, 20, -2)})[0];
  EXPECT_EQ(right.candidate, 0u);
  EXPECT_EQ(other.candidate, 1u);
  for (const Branch& branch : {right, other}) EXPECT_NEAR(branch.ambiguity, 1 / (1 + std::exp(2.0)), 1e-12);
  EXPECT_EQ(chosen({{0, {measured(tilted(20))}}})[0].ambiguity, 0);
}

TEST(TrajectoryBranches, AWrongFirstChoiceIsFoundOutByLaterFrames) {
  const auto branches = chosen(trajectory(20, resting, [](int i) { return i == 0 ? -4 : 0.8; }));
  EXPECT_EQ(candidates_of(branches), std::vector<std::size_t>(20, 0)) << "the first frame too";
}

TEST(TrajectoryBranches, TheFirstQuarterMisledIsFoundOutByTheRest) {
  const auto branches = chosen(trajectory(40, resting, [](int i) { return i < 10 ? -0.5 : 0.4; }));
  EXPECT_EQ(candidates_of(branches), std::vector<std::size_t>(40, 0));
}

/// From +30° through the frontal view to -30° at 60° a second, telling only in the frames that `favour` names.
template <class Favour>
int wrong_frames(Favour&& favour) {
  const auto tilt_deg = [](int i) { return 30.0 - 2 * i; };
  const auto branches = chosen(trajectory(31, tilt_deg, favour));
  int wrong = 0;
  for (int i = 0; i < 31; ++i) wrong += branches[static_cast<std::size_t>(i)].candidate != 0 && std::abs(tilt_deg(i)) > 6;
  return wrong;
}

TEST(TrajectoryBranches, EvidencePassesThroughTheFrontalViewForward) {
  EXPECT_EQ(wrong_frames([](int i) { return i < 5 ? 2.0 : 0; }), 0);
}

TEST(TrajectoryBranches, EvidencePassesThroughTheFrontalViewBackward) {
  EXPECT_EQ(wrong_frames([](int i) { return i > 25 ? 2.0 : 0; }), 0);
}

TEST(TrajectoryBranches, AMisleadingFrameDoesNotFlipHoweverSureItIs) {
  for (const int misled : {0, 7, 15, 29}) {
    const auto branches = chosen(trajectory(30, resting, [&](int i) { return i == misled ? -1e6 : 0.5; }));
    EXPECT_EQ(candidates_of(branches), std::vector<std::size_t>(30, 0)) << "misled at " << misled;
  }
}

TEST(TrajectoryBranches, WhereNothingTellsTheDoubtIsOneHalf) {
  for (const Branch& branch : chosen(trajectory(12, resting, [](int) { return 0; }))) EXPECT_NEAR(branch.ambiguity, 0.5, 1e-9);
}

TEST(TrajectoryBranches, TheDoubtIsThatOfAllFramesTogether) {
  // A tag at rest does not change its branch: the odds of ten frames multiply, but for the jumps that are never quite impossible.
  for (const Branch& branch : chosen(trajectory(10, resting, [](int) { return 0.3; })))
    EXPECT_NEAR(branch.ambiguity, 1 / (1 + std::exp(10 * 0.3)), 1e-3);
}

TEST(TrajectoryBranches, FramesWithOnePoseAnchorTheirNeighbours) {
  auto frames = trajectory(21, resting, [](int) { return 0; });
  frames[10].candidates.pop_back();
  const auto branches = chosen(frames);
  EXPECT_EQ(candidates_of(branches), std::vector<std::size_t>(21, 0));
  for (const Branch& branch : branches) EXPECT_LT(branch.ambiguity, 1e-3);
  EXPECT_EQ(branches[10].ambiguity, 0);
}

TEST(TrajectoryBranches, PosesAreFollowedWhicheverComesFirst) {
  auto frames = trajectory(20, resting, [](int) { return 0.5; });
  std::vector<std::size_t> expected(20, 0);
  for (std::size_t i = 0; i < 20; i += 3) {
    std::swap(frames[i].candidates[0], frames[i].candidates[1]);
    expected[i] = 1;
  }
  EXPECT_EQ(candidates_of(chosen(frames)), expected);
}

TEST(TrajectoryBranches, OfTwoSteadyTurnsThatCrossTheSteadierOneIsRight) {
  // No pixel tells; but only one branch turns on evenly: the other one's tilt is bent by the wobble of its mirror image.
  std::vector<TrajectoryFrame> frames;
  for (int i = 0; i < 40; ++i) {
    const double tilt_deg = 25 - 1.2 * i, bent_deg = -tilt_deg + (i % 2 ? 4 : -4);
    frames.push_back({i * kFrame_s, {measured(tilted(tilt_deg), {0.01, 1e-4}), measured(tilted(bent_deg), {0.01, 1e-4})}});
  }
  const auto branches = chosen(frames);
  EXPECT_EQ(candidates_of(branches), std::vector<std::size_t>(40, 0));
  EXPECT_LT(branches[3].ambiguity, 0.05);
}

TEST(TrajectoryBranches, TimeRunningBackwardMakesTheSameChoice) {
  auto frames = trajectory(
      30, [](int i) { return 30.0 - 2 * i; }, [](int i) { return i % 5 == 0 ? -0.4 : 0.5; });
  const auto forward = candidates_of(chosen(frames));
  std::reverse(frames.begin(), frames.end());
  for (TrajectoryFrame& frame : frames) frame.time_s = -frame.time_s;
  auto backward = candidates_of(chosen(frames));
  std::reverse(backward.begin(), backward.end());
  // Within 2° of frontal both poses are nearly one: either may be taken.
  for (std::size_t i = 0; i < 30; ++i) {
    if (i >= 14 && i <= 16) continue;
    EXPECT_EQ(forward[i], backward[i]) << i;
  }
}

TEST(TrajectoryBranches, RepeatedTimesAndHugeOddsStayFinite) {
  std::vector<TrajectoryFrame> frames;
  for (int i = 0; i < 12; ++i) frames.push_back(ambiguous((i / 3) * kFrame_s, 20, i % 2 ? 1e300 : 0.5));
  for (const Branch& branch : chosen(frames)) {
    EXPECT_EQ(branch.candidate, 0u);
    EXPECT_GE(branch.ambiguity, 0);
    EXPECT_LE(branch.ambiguity, 0.5);
  }
}

}  // namespace
}  // namespace catchlight::tracking
