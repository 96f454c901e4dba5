// Whole paths: which frames get a pose, from where, and what stretches owe each other.
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
std::vector<PathFrame> path(int frames, Seen&& is_seen, double rate = 30) {
  std::vector<PathFrame> result;
  for (int i = 0; i < frames; ++i) {
    PathFrame& frame = result.emplace_back(PathFrame{i / rate, {}});
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

TEST(PathSolver, NoFramesHaveNoPath) {
  EXPECT_TRUE(solve_path({}, kCoast_s).empty());
}

TEST(PathSolver, ATagThatIsNeverSeenIsLostThroughout) {
  EXPECT_EQ(states_of(solve_path(path(8, [](int) { return false; }), kCoast_s)), "........");
}

TEST(PathSolver, AfterItWasSeenItCoastsForTheCoastingTimeToTheFrame) {
  const auto first_four = [](int i) { return i < 4; };
  EXPECT_EQ(states_of(solve_path(path(14, first_four), kCoast_s)), "ttttcccccc....") << "0.2 s are six frames";
  EXPECT_EQ(states_of(solve_path(path(8, first_four, 12), kCoast_s)), "ttttcc..") << "at 12 frames a second, two";
  EXPECT_EQ(states_of(solve_path(path(30, first_four, 120), kCoast_s)), "tttt" + std::string(24, 'c') + "..");
  EXPECT_EQ(states_of(solve_path(path(6, first_four), 0)), "tttt..");
}

TEST(PathSolver, TimesRoundedToMicrosecondsCountTheSameFrames) {
  auto frames = path(14, [](int i) { return i < 4; });
  for (PathFrame& frame : frames) frame.time_s = std::round(frame.time_s * 1e6) / 1e6;
  EXPECT_EQ(states_of(solve_path(frames, kCoast_s)), "ttttcccccc....");
}

TEST(PathSolver, BeforeItWasFirstSeenItIsLost) {
  EXPECT_EQ(states_of(solve_path(path(6, [](int i) { return i >= 4; }), kCoast_s)), "....tt");
}

TEST(PathSolver, AShortGapIsBridgedOnTheTrueLine) {
  const auto frames = path(40, [](int i) { return i < 15 || i > 19; });
  const auto poses = solve_path(frames, kCoast_s);
  EXPECT_EQ(states_of(poses), std::string(15, 't') + "ccccc" + std::string(20, 't'));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT(shift_between_m(poses[i].camera_from_tag, steady(frames[i].time_s)), 1e-6) << i;
    EXPECT_LT(turn_between_rad(poses[i].camera_from_tag, steady(frames[i].time_s)), 1e-6) << i;
  }
}

TEST(PathSolver, AGapOfExactlyTheCoastingTimeIsStillBridged) {
  const auto seen_but = [](int gap) { return [gap](int i) { return i < 10 || i >= 10 + gap; }; };
  EXPECT_EQ(states_of(solve_path(path(20, seen_but(5)), kCoast_s)), "ttttttttttccccc" + std::string(5, 't'));
  EXPECT_EQ(states_of(solve_path(path(20, seen_but(6)), kCoast_s)), "ttttttttttcccccc" + std::string(4, 't'));
  EXPECT_EQ(states_of(solve_path(path(20, seen_but(8)), kCoast_s)), "ttttttttttcccccc..tt");
}

TEST(PathSolver, StretchesAcrossALongGapKnowNothingOfEachOther) {
  Noise noise(4);
  auto frames = path(60, [](int i) { return i < 25 || i >= 35; });
  for (PathFrame& frame : frames)
    if (!frame.candidates.empty()) frame.candidates = {noise.measured(steady(frame.time_s), {1e-2, 1e-3})};
  const auto together = solve_path(frames, kCoast_s);
  const auto first = solve_path(std::span(frames).first(35), kCoast_s), second = solve_path(std::span(frames).last(25), kCoast_s);
  for (std::size_t i = 0; i < 60; ++i) EXPECT_TRUE(same_bits(together[i], i < 35 ? first[i] : second[i - 35])) << i;
}

TEST(PathSolver, AWrongFirstChoiceIsCorrectedInThePosesThemselves) {
  std::vector<PathFrame> frames;
  for (int i = 0; i < 20; ++i) frames.push_back(ambiguous(i * kFrame_s, 20, i < 3 ? -2 : 1));
  const auto poses = solve_path(frames, kCoast_s);
  for (const SolvedPose& pose : poses) {
    EXPECT_LT(turn_between_deg(pose.camera_from_tag, tilted(20)), 0.01);
    EXPECT_LT(pose.ambiguity, 0.01);
  }
}

TEST(PathSolver, CoastingFramesInABranchesGapBelongToTheChosenBranch) {
  std::vector<PathFrame> frames;
  for (int i = 0; i < 20; ++i) frames.push_back(ambiguous(i * kFrame_s, 20, i < 8 ? 0 : 1));
  for (std::size_t i = 8; i < 12; ++i) frames[i].candidates.clear();
  const auto poses = solve_path(frames, kCoast_s);
  EXPECT_EQ(states_of(poses), "ttttttttcccctttttttt");
  for (const SolvedPose& pose : poses) EXPECT_LT(turn_between_deg(pose.camera_from_tag, tilted(20)), 0.01);
  EXPECT_EQ(poses[9].ambiguity, 0) << "nothing was measured that could be doubted";
}

TEST(PathSolver, AFrameSeenAloneIsAStretchOfItsOwn) {
  const auto poses = solve_path(path(20, [](int i) { return i == 5; }), kCoast_s);
  EXPECT_EQ(states_of(poses), ".....tcccccc........");
  for (std::size_t i = 5; i < 12; ++i)
    EXPECT_LT(shift_between_m(poses[i].camera_from_tag, steady(5 * kFrame_s)), 1e-12) << "nothing is known of its motion";
}

}  // namespace
}  // namespace catchlight::tracking
