// Recorded footage, rendered: what later frames tell about earlier ones.
#include "tracking/shot_tracker.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/track.hpp"
#include "tests/support/pose_error.hpp"
#include "tests/support/synthetic_tag.hpp"

#include <gtest/gtest.h>

namespace catchlight::tracking {
namespace {

constexpr double kFrame_s = 1.0 / 30;

/// A long lens: quick to render, a tag of 8 cm at 1.3 m is 61 px large.
CameraModel small_camera() {
  return {200, 160, 1000, 1000, 99.5, 79.5, {}};
}

TagTarget target() {
  return {{"tag36h11", 5, 0.08}, {}};
}

std::vector<std::uint8_t> frame_of(const std::vector<SyntheticTag>& tags, unsigned seed) {
  SyntheticScene scene{small_camera(), tags};
  scene.noise_codes = 1;
  scene.seed = seed;
  return render(scene).codes;
}

using Footage = std::vector<std::vector<std::uint8_t>>;

struct Solved {
  std::vector<TrackState> at_once;  ///< as add() said
  std::vector<SolvedPose> poses;
  std::size_t appearances = 0;
};

Solved solve(const Footage& footage, const TrackerOptions& options = {}) {
  ShotTracker tracker(small_camera(), target(), options);
  Solved solved;
  for (std::size_t i = 0; i < footage.size(); ++i)
    solved.at_once.push_back(tracker.add({footage[i].data(), 200, 160, 200}, static_cast<double>(i) * kFrame_s).state);
  solved.poses = tracker.solve();
  solved.appearances = tracker.appearances().size();
  return solved;
}

double corner_rms_px(const RigidTransform& solved, const RigidTransform& truth) {
  return rms_distance(true_corners_px(small_camera(), {target(), solved}), true_corners_px(small_camera(), {target(), truth}));
}

/// Comes in from the left, cut off by the picture's edge at first.
RigidTransform entering(std::size_t frame) {
  return tag_pose(small_camera(), {-8 + 6 * static_cast<double>(frame), 80}, 1.3, {30, 20, 5});
}

const Footage& entering_footage() {
  static const Footage footage = [] {
    Footage frames;
    for (std::size_t i = 0; i < 12; ++i) frames.push_back(frame_of({{target(), entering(i)}}, static_cast<unsigned>(i)));
    return frames;
  }();
  return footage;
}

std::size_t first_tracked(const auto& states) {
  return static_cast<std::size_t>(std::find(states.begin(), states.end(), TrackState::tracking) - states.begin());
}

std::vector<TrackState> states_of(const Solved& solved) {
  std::vector<TrackState> states;
  for (const SolvedPose& pose : solved.poses) states.push_back(pose.state);
  return states;
}

TEST(ShotTracker, ATagThatComesInIsFollowedBackwardToWhereItCannotBeDetected) {
  const Solved solved = solve(entering_footage());
  const std::size_t detected = first_tracked(solved.at_once), followed = first_tracked(states_of(solved));
  ASSERT_LT(detected, 12u);
  ASSERT_GE(detected, 2u) << "or there is nothing to look back at";
  EXPECT_LE(followed + 2, detected);
  for (std::size_t i = followed; i < solved.poses.size(); ++i) {
    EXPECT_EQ(solved.poses[i].state, TrackState::tracking) << i;
    EXPECT_LT(corner_rms_px(solved.poses[i].camera_from_tag, entering(i)), 0.1) << i;
  }
  EXPECT_EQ(solved.appearances, entering_footage().size());
}

TEST(ShotTracker, ACutDoesNotLeakBackward) {
  // The scene before shows nothing, or a tag of another number in the very same place.
  for (const bool has_other_tag : {false, true}) {
    const RigidTransform pose = tag_pose(small_camera(), {100, 80}, 1.3, {30, 20, 5});
    SyntheticTag other{target(), pose};
    other.target.id = 23;
    Footage footage;
    for (unsigned i = 0; i < 6; ++i)
      footage.push_back(frame_of(has_other_tag ? std::vector{other} : std::vector<SyntheticTag>{}, i));
    for (unsigned i = 6; i < 12; ++i) footage.push_back(frame_of({{target(), pose}}, i));
    const Solved solved = solve(footage);
    EXPECT_EQ(first_tracked(states_of(solved)), 6u) << (has_other_tag ? "another tag" : "an empty scene");
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(solved.poses[i].state, TrackState::lost) << i;
  }
}

TEST(ShotTracker, ACutToAnEmptySceneCoastsAndEnds) {
  const RigidTransform pose = tag_pose(small_camera(), {100, 80}, 1.3, {30, 20, 5});
  Footage footage;
  for (unsigned i = 0; i < 14; ++i)
    footage.push_back(frame_of(i < 4 ? std::vector{SyntheticTag{target(), pose}} : std::vector<SyntheticTag>{}, i));
  const auto states = states_of(solve(footage));
  EXPECT_EQ(states[3], TrackState::tracking);
  EXPECT_EQ(states[4], TrackState::coasting);
  EXPECT_EQ(states[9], TrackState::coasting);
  EXPECT_EQ(states[10], TrackState::lost) << "0.2 s after it was last seen";
}

TEST(ShotTracker, TheSameFramesGiveTheSameBytes) {
  const Solved once = solve(entering_footage()), again = solve(entering_footage());
  for (std::size_t i = 0; i < once.poses.size(); ++i) {
    EXPECT_EQ(again.poses[i].state, once.poses[i].state);
    EXPECT_EQ(again.poses[i].camera_from_tag.rotation, once.poses[i].camera_from_tag.rotation) << i;
    EXPECT_EQ(again.poses[i].camera_from_tag.translation_m, once.poses[i].camera_from_tag.translation_m) << i;
    EXPECT_EQ(again.poses[i].covariance, once.poses[i].covariance) << i;
  }
}

TEST(ShotTracker, FootageWithoutFramesHasNoTrajectory) {
  EXPECT_TRUE(solve({}).poses.empty());
}

TEST(ShotTracker, AFrameOfAnotherSizeIsRefused) {
  ShotTracker tracker(small_camera(), target());
  const std::vector<std::uint8_t> codes(100 * 100, 128);
  EXPECT_THROW(tracker.add({codes.data(), 100, 100, 100}, 0), Error);
}

TEST(ShotTracker, RowsThatAreFurtherApartThanTheirWidthAreRead) {
  // Decoders pad their rows; frames are kept to be looked at again.
  Footage padded;
  for (const auto& frame : entering_footage()) {
    auto& rows = padded.emplace_back(232u * 160u, std::uint8_t{77});
    for (std::size_t y = 0; y < 160; ++y) std::copy_n(&frame[y * 200], 200, &rows[y * 232]);
  }
  ShotTracker tracker(small_camera(), target());
  for (std::size_t i = 0; i < padded.size(); ++i)
    tracker.add({padded[i].data(), 200, 160, 232}, static_cast<double>(i) * kFrame_s);
  const auto poses = tracker.solve();
  const Solved expected = solve(entering_footage());
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_EQ(poses[i].camera_from_tag.translation_m, expected.poses[i].camera_from_tag.translation_m) << i;
}

}  // namespace
}  // namespace catchlight::tracking
