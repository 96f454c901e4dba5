// The tracker as its users see it: states, coasting, re-entry, two copies of one tag, and what it refuses.
#include "tracking/tracker.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/track.hpp"
#include "tests/support/pose_error.hpp"
#include "tests/support/synthetic_tag.hpp"
#include "tracking/observation.hpp"
#include "tracking/tracker_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace catchlight::tracking {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kFrame_s = 1.0 / 25;

SyntheticTag tag_at(const glm::dvec2& center_px, double distance_m, const glm::dvec3& turn_deg = {35, 10, 20}) {
  SyntheticTag tag;
  tag.camera_from_tag = tag_pose(plain_camera(), center_px, distance_m, turn_deg);
  return tag;
}

SyntheticFrame frame_of(const std::vector<SyntheticTag>& tags) {
  SyntheticScene scene;
  scene.camera = plain_camera();
  scene.tags = tags;
  return render(scene);
}

/// A tag moving right by 4 px a frame.
SyntheticTag moving_tag(int frame) {
  return tag_at({250.0 + 4 * frame, 240}, 0.6);
}

TEST(Tracker, FindsThePoseOfARenderedTag) {
  for (const glm::dvec3& turn_deg : {glm::dvec3(35, 10, 20), glm::dvec3(-40, 25, -100), glm::dvec3(60, 0, 180)}) {
    const SyntheticTag tag = tag_at({300, 220}, 0.5, turn_deg);
    const TagObservation seen = Tracker(plain_camera(), {}).track(frame_of({tag}).luma(), 0);
    ASSERT_EQ(seen.state, TrackState::tracking);
    // Cells down to 6 px across and 8-bit codes without noise to dither them.
    EXPECT_LT(rms_distance(seen.corners_px, true_corners_px(plain_camera(), tag)), 0.02);
    EXPECT_LT(turn_between_deg(seen.camera_from_tag, tag.camera_from_tag), 0.05);
    EXPECT_LT(glm::distance(seen.camera_from_tag.translation_m, tag.camera_from_tag.translation_m), 1e-4);
    EXPECT_LT(seen.corner_sigma_px, 0.01);
    EXPECT_EQ(seen.candidates.size(), 1u) << "a tilted, large tag is not ambiguous";
    EXPECT_EQ(seen.ambiguity, 0);
  }
}

TEST(Tracker, FindsThePoseThroughADistortingLens) {
  SyntheticScene scene;
  scene.camera = distorted_camera();
  scene.tags.resize(1);
  scene.tags[0].camera_from_tag = tag_pose(scene.camera, {200, 320}, 0.4, {30, -25, 60});
  const TagObservation seen = Tracker(scene.camera, {}).track(render(scene).luma(), 0);
  ASSERT_EQ(seen.state, TrackState::tracking);
  EXPECT_LT(turn_between_deg(seen.camera_from_tag, scene.tags[0].camera_from_tag), 0.05);
  EXPECT_LT(glm::distance(seen.camera_from_tag.translation_m, scene.tags[0].camera_from_tag.translation_m), 1e-4);
}

TEST(Tracker, CoastsAlongTheMotionThenLosesTheTag) {
  TrackerOptions options;
  options.coast_s = 0.2;  // five frames
  Tracker tracker(plain_camera(), {}, options);
  for (int frame = 0; frame < 4; ++frame)
    ASSERT_EQ(tracker.track(frame_of({moving_tag(frame)}).luma(), frame * kFrame_s).state, TrackState::tracking);

  const SyntheticFrame empty = frame_of({});
  for (int frame = 4; frame < 9; ++frame) {
    const TagObservation coasting = tracker.track(empty.luma(), frame * kFrame_s);
    EXPECT_EQ(coasting.state, TrackState::coasting) << frame;
    EXPECT_LT(rms_distance(coasting.corners_px, true_corners_px(plain_camera(), moving_tag(frame))), 1.0) << frame;
  }
  for (int frame = 9; frame < 12; ++frame) EXPECT_EQ(tracker.track(empty.luma(), frame * kFrame_s).state, TrackState::lost);
}

TEST(Tracker, WithoutCoastingALostTagIsLostAtOnce) {
  TrackerOptions options;
  options.coast_s = 0;
  Tracker tracker(plain_camera(), {}, options);
  tracker.track(frame_of({moving_tag(0)}).luma(), 0);
  EXPECT_EQ(tracker.track(frame_of({}).luma(), kFrame_s).state, TrackState::lost);
}

TEST(Tracker, AReturningTagIsFoundInItsFirstFrameWhereverItIs) {
  for (const double gap_s : {2 * kFrame_s, 1.0, 100.0}) {
    Tracker tracker(plain_camera(), {});
    tracker.track(frame_of({tag_at({150, 150}, 0.6)}).luma(), 0);
    tracker.track(frame_of({}).luma(), gap_s / 2);
    const SyntheticTag back = tag_at({450, 350}, 0.6, {-30, 20, 170});
    const TagObservation seen = tracker.track(frame_of({back}).luma(), gap_s);
    ASSERT_EQ(seen.state, TrackState::tracking) << gap_s;
    EXPECT_LT(turn_between_deg(seen.camera_from_tag, back.camera_from_tag), 0.1) << gap_s;
  }
}

TEST(Tracker, NoTagEverSeenIsLostFromTheStart) {
  Tracker tracker(plain_camera(), {});
  const SyntheticFrame empty = frame_of({});
  for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(tracker.track(empty.luma(), frame * kFrame_s).state, TrackState::lost);
}

TEST(Tracker, ATagOfAnotherIdIsNotTheTarget) {
  TagTarget other;
  other.id = 5;
  EXPECT_EQ(Tracker(plain_camera(), other).track(frame_of({moving_tag(0)}).luma(), 0).state, TrackState::lost);
}

TEST(Tracker, OfTwoCopiesTheLargerIsTakenFirst) {
  const SyntheticTag large = tag_at({430, 240}, 0.5), small = tag_at({120, 120}, 1.2);
  const TagObservation seen = Tracker(plain_camera(), {}).track(frame_of({small, large}).luma(), 0);
  EXPECT_LT(rms_distance(seen.corners_px, true_corners_px(plain_camera(), large)), 0.1);
}

TEST(Tracker, OfTwoCopiesTheOneWhereTheTagWasIsKept) {
  // The tracked tag is the smaller one; a larger copy comes into view.
  const SyntheticTag small = tag_at({150, 150}, 1.0), large = tag_at({430, 240}, 0.5);
  Tracker tracker(plain_camera(), {});
  tracker.track(frame_of({small}).luma(), 0);
  const TagObservation seen = tracker.track(frame_of({small, large}).luma(), kFrame_s);
  EXPECT_LT(rms_distance(seen.corners_px, true_corners_px(plain_camera(), small)), 0.1);
}

TEST(Tracker, WhereTheTagIsHiddenForAMomentItDoesNotJumpToAThumbnailOfIt) {
  const SyntheticTag large = tag_at({430, 240}, 0.5), thumbnail = tag_at({120, 120}, 1.2);
  Tracker tracker(plain_camera(), {});
  tracker.track(frame_of({thumbnail, large}).luma(), 0);
  EXPECT_EQ(tracker.track(frame_of({thumbnail}).luma(), kFrame_s).state, TrackState::coasting);
  const TagObservation back = tracker.track(frame_of({thumbnail, large}).luma(), 2 * kFrame_s);
  EXPECT_EQ(back.state, TrackState::tracking);
  EXPECT_LT(rms_distance(back.corners_px, true_corners_px(plain_camera(), large)), 0.1);
  // Once the large one has been gone for longer than coasting lasts, the thumbnail is the tag.
  EXPECT_EQ(tracker.track(frame_of({thumbnail}).luma(), 1.0).state, TrackState::tracking);
}

TEST(Tracker, TheSameFramesGiveTheSameBytes) {
  Tracker a(plain_camera(), {}), b(plain_camera(), {});
  for (int frame = 0; frame < 3; ++frame) {
    SyntheticScene scene;
    scene.camera = plain_camera();
    scene.tags = {moving_tag(frame)};
    scene.noise_codes = 4;
    scene.seed = static_cast<unsigned>(frame);
    const SyntheticFrame image = render(scene);
    const TagObservation from_a = a.track(image.luma(), frame * kFrame_s), from_b = b.track(image.luma(), frame * kFrame_s);
    EXPECT_EQ(from_a.corners_px, from_b.corners_px);
    EXPECT_EQ(from_a.camera_from_tag.rotation, from_b.camera_from_tag.rotation);
    EXPECT_EQ(from_a.camera_from_tag.translation_m, from_b.camera_from_tag.translation_m);
  }
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "(no error)";
}

TEST(Tracker, RefusesAFrameOfAnotherSizeThanTheCamera) {
  const std::vector<std::uint8_t> codes(320 * 240, 100);
  Tracker tracker(plain_camera(), {});
  EXPECT_THAT(message_of([&] {
                tracker.track({codes.data(), 320, 240, 320}, 0);
              }),
              AllOf(HasSubstr("320x240"), HasSubstr("640x480")));
}

TEST(Tracker, RefusesTargetsThatCannotBe) {
  TagTarget unknown_family, unknown_id, no_size, no_number;
  unknown_family.family = "aruco";
  unknown_id.id = 587;
  no_size.size_m = 0;
  no_number.size_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message_of([&] { Tracker(plain_camera(), unknown_family); }), AllOf(HasSubstr("aruco"), HasSubstr("tag25h9")));
  EXPECT_THAT(message_of([&] { Tracker(plain_camera(), unknown_id); }), AllOf(HasSubstr("587"), HasSubstr("586")));
  EXPECT_THAT(message_of([&] { Tracker(plain_camera(), no_size); }), HasSubstr("size"));
  EXPECT_THAT(message_of([&] { Tracker(plain_camera(), no_number); }), HasSubstr("size"));
  EXPECT_THROW(Tracker(CameraModel{}, {}), Error);
}

}  // namespace
}  // namespace catchlight::tracking
