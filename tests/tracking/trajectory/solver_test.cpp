// Whole trajectories: which frames get a pose, from where, and what stretches owe each other.
#include "tracking/trajectory/solver.hpp"
#include "catchlight/track.hpp"
#include "tests/tracking/trajectory/trajectory_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace catchlight::tracking {
namespace {

using namespace path_test;

constexpr double kCoast_s = 0.2;

/// Steady motion at `rate` frames a second; `is_seen` of the frame's number.
template <class Seen>
std::vector<TrajectoryFrame> trajectory(int frames, Seen&& is_seen, double rate = 30) {
  std::vector<TrajectoryFrame> result;
  for (int i = 0; i < frames; ++i) {
    TrajectoryFrame& frame = result.emplace_back(TrajectoryFrame{i / rate, {}});
    if (is_seen(i)) frame.candidates = {measured(steady(frame.time_s))};
  }
  return result;
}

/// "t" tracking, "c" coasting, "." lost.
std::string states_of(const std::vector<SolvedPose>& poses) {
  std::string states;
  for (const SolvedPose& pose : poses)
    states += pose.state == TrackState::tracking ? 't' : pose.state == TrackState::coasting ? 'c' : '.';
  return states;
}

bool same_bits(const SolvedPose& a, const SolvedPose& b) {
  return a.state == b.state && a.camera_from_tag.rotation == b.camera_from_tag.rotation &&
         a.camera_from_tag.translation_m == b.camera_from_tag.translation_m && a.covariance == b.covariance &&
         a.ambiguity == b.ambiguity;
}

TEST(TrajectorySolver, NoFramesHaveNoTrajectory) {
  EXPECT_TRUE(solve_trajectory({}, kCoast_s).empty());
}

TEST(TrajectorySolver, ATagThatIsNeverSeenIsLostThroughout) {
  EXPECT_EQ(states_of(solve_trajectory(trajectory(8, [](int) { return false; }), kCoast_s)), "........");
}

TEST(TrajectorySolver, AfterItWasSeenItCoastsForTheCoastingTimeToTheFrame) {
  const auto first_four = [](int i) { return i < 4; };
  EXPECT_EQ(states_of(solve_trajectory(trajectory(14, first_four), kCoast_s)), "ttttcccccc....") << "0.2 s are six frames";
  EXPECT_EQ(states_of(solve_trajectory(trajectory(8, first_four, 12), kCoast_s)), "ttttcc..") << "at 12 frames a second, two";
  EXPECT_EQ(states_of(solve_trajectory(trajectory(30, first_four, 120), kCoast_s)), "tttt" + std::string(24, 'c') + "..");
  EXPECT_EQ(states_of(solve_trajectory(trajectory(6, first_four), 0)), "tttt..");
}

TEST(TrajectorySolver, TimesRoundedToMicrosecondsCountTheSameFrames) {
  auto frames = trajectory(14, [](int i) { return i < 4; });
  for (TrajectoryFrame& frame : frames) frame.time_s = std::round(frame.time_s * 1e6) / 1e6;
  EXPECT_EQ(states_of(solve_trajectory(frames, kCoast_s)), "ttttcccccc....");
}

TEST(TrajectorySolver, BeforeItWasFirstSeenItIsLost) {
  EXPECT_EQ(states_of(solve_trajectory(trajectory(6, [](int i) { return i >= 4; }), kCoast_s)), "....tt");
}

TEST(TrajectorySolver, AShortGapIsBridgedOnTheTrueLine) {
  const auto frames = trajectory(40, [](int i) { return i < 15 || i > 19; });
  const auto poses = solve_trajectory(frames, kCoast_s);
  EXPECT_EQ(states_of(poses), std::string(15, 't') + "ccccc" + std::string(20, 't'));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT(shift_between_m(poses[i].camera_from_tag, steady(frames[i].time_s)), 1e-6) << i;
    EXPECT_LT(turn_between_rad(poses[i].camera_from_tag, steady(frames[i].time_s)), 1e-6) << i;
  }
}

TEST(TrajectorySolver, AGapOfExactlyTheCoastingTimeIsStillBridged) {
  const auto seen_but = [](int gap) { return [gap](int i) { return i < 10 || i >= 10 + gap; }; };
  EXPECT_EQ(states_of(solve_trajectory(trajectory(20, seen_but(5)), kCoast_s)), "ttttttttttccccc" + std::string(5, 't'));
  EXPECT_EQ(states_of(solve_trajectory(trajectory(20, seen_but(6)), kCoast_s)), "ttttttttttcccccc" + std::string(4, 't'));
  EXPECT_EQ(states_of(solve_trajectory(trajectory(20, seen_but(8)), kCoast_s)), "ttttttttttcccccc..tt");
}

TEST(TrajectorySolver, StretchesAcrossALongGapKnowNothingOfEachOther) {
  Noise noise(4);
  auto frames = trajectory(60, [](int i) { return i < 25 || i >= 35; });
  for (TrajectoryFrame& frame : frames)
    if (!frame.candidates.empty()) frame.candidates = {noise.measured(steady(frame.time_s), {1e-2, 1e-3})};
  const auto together = solve_trajectory(frames, kCoast_s);
  const auto first = solve_trajectory(std::span(frames).first(35), kCoast_s),
             second = solve_trajectory(std::span(frames).last(25), kCoast_s);
  for (std::size_t i = 0; i < 60; ++i) EXPECT_TRUE(same_bits(together[i], i < 35 ? first[i] : second[i - 35])) << i;
}

TEST(TrajectorySolver, AWrongFirstChoiceIsCorrectedInThePosesThemselves) {
  std::vector<TrajectoryFrame> frames;
  for (int i = 0; i < 20; ++i) frames.push_back(ambiguous(i * kFrame_s, 20, i < 3 ? -2 : 1));
  const auto poses = solve_trajectory(frames, kCoast_s);
  for (const SolvedPose& pose : poses) {
    EXPECT_LT(turn_between_deg(pose.camera_from_tag, tilted(20)), 0.01);
    EXPECT_LT(pose.ambiguity, 0.01);
  }
}

TEST(TrajectorySolver, CoastingFramesInABranchesGapBelongToTheChosenBranch) {
  std::vector<TrajectoryFrame> frames;
  for (int i = 0; i < 20; ++i) frames.push_back(ambiguous(i * kFrame_s, 20, i < 8 ? 0 : 1));
  for (std::size_t i = 8; i < 12; ++i) frames[i].candidates.clear();
  const auto poses = solve_trajectory(frames, kCoast_s);
  EXPECT_EQ(states_of(poses), "ttttttttcccctttttttt");
  for (const SolvedPose& pose : poses) EXPECT_LT(turn_between_deg(pose.camera_from_tag, tilted(20)), 0.01);
  EXPECT_EQ(poses[9].ambiguity, 0) << "nothing was measured that could be doubted";
}

TEST(TrajectorySolver, AFrameSeenAloneIsAStretchOfItsOwn) {
  const auto poses = solve_trajectory(trajectory(20, [](int i) { return i == 5; }), kCoast_s);
  EXPECT_EQ(states_of(poses), ".....tcccccc........");
  for (std::size_t i = 5; i < 12; ++i)
    EXPECT_LT(shift_between_m(poses[i].camera_from_tag, steady(5 * kFrame_s)), 1e-12) << "nothing is known of its motion";
}

}  // namespace
}  // namespace catchlight::tracking
