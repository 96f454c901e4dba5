// Each way in which tag tracking is known to fail, by name. Stress rises over a few frames, as it does in footage.
#include <gtest/gtest.h>

#include "catchlight/camera.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/track.hpp"
#include "tests/support/pose_error.hpp"
#include "tests/support/synthetic_tag.hpp"
#include "tracking/observation.hpp"
#include "tracking/tracker.hpp"

namespace catchlight::tracking {
namespace {

constexpr double kFrame_s = 1.0 / 24;

CameraModel long_lens() {
  return {240, 200, 1000, 1000, 119.5, 99.5, {}};
}

SyntheticScene tag_scene(const CameraModel& camera, const glm::dvec2& center_px, double side_px, const glm::dvec3& turn_deg,
                         int frame = 0) {
  SyntheticScene scene;
  scene.camera = camera;
  scene.tags.resize(1);
  scene.tags[0].camera_from_tag = tag_pose(camera, center_px, camera.fx_px * 0.08 / side_px, turn_deg);
  scene.noise_codes = 3;
  scene.blur_px = 0.7;
  scene.paper_margin_cells = 2;
  scene.seed = static_cast<unsigned>(frame + 1);
  return scene;
}

/// Light of the tag moving by `motion_px` while the shutter is open.
SyntheticFrame render_moving(SyntheticScene scene, const glm::dvec2& motion_px) {
  const int kSteps = motion_px == glm::dvec2(0) ? 1 : 9;
  const RigidTransform middle = scene.tags[0].camera_from_tag;
  const double noise_codes = std::exchange(scene.noise_codes, 0);
  SyntheticFrame sum;
  for (int step = 0; step < kSteps; ++step) {
    const glm::dvec2 shift_px = motion_px * ((step + 0.5) / kSteps - 0.5);
    scene.tags[0].camera_from_tag = middle;
    scene.tags[0].camera_from_tag.translation_m += glm::dvec3(shift_px * middle.translation_m.z / scene.camera.fx_px, 0);
    const SyntheticFrame instant = render(scene);
    if (step == 0) sum = SyntheticFrame{instant.width_px, instant.height_px, std::vector<float>(instant.linear.size()), {}};
    for (std::size_t i = 0; i < sum.linear.size(); ++i) sum.linear[i] += instant.linear[i] / static_cast<float>(kSteps);
  }
  sum.codes = expose(sum.linear, noise_codes, scene.seed);
  return sum;
}

/// A hand over the tag's side between its first two corners, reaching over `share` of it.
void cover(SyntheticFrame& frame, const SyntheticScene& scene, double share, std::uint8_t code) {
  const auto corners_px = true_corners_px(scene.camera, scene.tags[0]);
  const glm::dvec2 along = corners_px[1] - corners_px[0], across = corners_px[3] - corners_px[0];
  for (int y = 0; y < frame.height_px; ++y)
    for (int x = 0; x < frame.width_px; ++x) {
      const glm::dvec2 from = glm::dvec2(x, y) - corners_px[0];
      const double u = glm::dot(from, along) / glm::dot(along, along), v = glm::dot(from, across) / glm::dot(across, across);
      if (u > -0.2 && u < 1.2 && v > -0.5 && v < share) frame.codes[static_cast<std::size_t>(y * frame.width_px + x)] = code;
    }
}

double corner_error_px(const SyntheticScene& scene, const TagObservation& seen) {
  SyntheticTag found = scene.tags[0];
  found.camera_from_tag = seen.camera_from_tag;
  return rms_distance(true_corners_px(scene.camera, found), true_corners_px(scene.camera, scene.tags[0]));
}

void expect_tracked(const SyntheticScene& scene, const TagObservation& seen, double most_px, const std::string& when) {
  ASSERT_EQ(seen.state, TrackState::tracking) << when;
  EXPECT_LT(corner_error_px(scene, seen), most_px) << when;
}

TEST(Stability, TiltOf80Degrees) {
  Tracker tracker(long_lens(), {});
  for (int frame = 0; frame <= 15; ++frame) {
    const double tilt_deg = 50 + 2.0 * frame;
    const SyntheticScene scene = tag_scene(long_lens(), {120, 100}, 100, {tilt_deg, 0, 25}, frame);
    expect_tracked(scene, tracker.track(render(scene).luma(), frame * kFrame_s), 0.08, std::to_string(tilt_deg));
  }
}

TEST(Stability, TagOf20Px) {
  Tracker tracker(long_lens(), {});
  for (int frame = 0; frame <= 10; ++frame) {
    const double side_px = 40 - 2.0 * frame;
    const SyntheticScene scene = tag_scene(long_lens(), {120.0 + frame, 100}, side_px, {30, 15, 20}, frame);
    expect_tracked(scene, tracker.track(render(scene).luma(), frame * kFrame_s), 0.1, std::to_string(side_px));
  }
}

TEST(Stability, MotionBlurOf8Px) {
  Tracker tracker(long_lens(), {});
  for (int frame = 0; frame <= 4; ++frame) {
    const glm::dvec2 motion_px = glm::dvec2(7, 4) * (frame / 4.0);
    const SyntheticScene scene = tag_scene(long_lens(), {100.0 + 7 * frame, 90.0 + 4 * frame}, 80, {30, 10, -20}, frame);
    const TagObservation seen = tracker.track(render_moving(scene, motion_px).luma(), frame * kFrame_s);
    expect_tracked(scene, seen, 0.1, std::to_string(glm::length(motion_px)) + " px");
    if (frame < 4) continue;
    // A shutter open for a motion of 8.06 px spreads light by 8.06²/12 along it, beside the lens's own 0.57.
    ASSERT_TRUE(seen.appearance);
    const Covariance2 blur = seen.appearance->blur_px2;
    const glm::dvec2 direction = glm::normalize(motion_px), normal(-direction.y, direction.x);
    const auto along = [&](const glm::dvec2& d) { return d.x * d.x * blur.xx + 2 * d.x * d.y * blur.xy + d.y * d.y * blur.yy; };
    EXPECT_NEAR(along(direction), 8.06 * 8.06 / 12 + 0.57, 0.8);
    EXPECT_NEAR(along(normal), 0.57, 0.25);
  }
}

TEST(Stability, ThirtyPercentCovered) {
  for (const int code : {60, 110, 180}) {
    Tracker tracker(long_lens(), {});
    for (int frame = 0; frame <= 6; ++frame) {
      const SyntheticScene scene = tag_scene(long_lens(), {118.0 + frame, 100}, 90, {25, -20, 10}, frame);
      SyntheticFrame image = render(scene);
      if (frame > 0) cover(image, scene, 0.05 * frame, static_cast<std::uint8_t>(code));
      const TagObservation seen = tracker.track(image.luma(), frame * kFrame_s);
      expect_tracked(scene, seen, 0.06, "code " + std::to_string(code) + ", frame " + std::to_string(frame));
      if (frame < 6) continue;
      ASSERT_TRUE(seen.appearance);
      EXPECT_GT(seen.appearance->occluded_share, 0.2);
    }
  }
}

TEST(Stability, CutByThePicturesEdge) {
  Tracker tracker(long_lens(), {});
  for (int frame = 0; frame <= 8; ++frame) {  // at the end a third of it is outside
    const SyntheticScene scene = tag_scene(long_lens(), {150.0 + 9 * frame, 100}, 80, {25, 20, 10}, frame);
    expect_tracked(scene, tracker.track(render(scene).luma(), frame * kFrame_s), 0.1, "frame " + std::to_string(frame));
  }
}

TEST(Stability, StrongDistortion) {
  CameraModel camera = {320, 240, 260, 260, 159.5, 119.5, {-0.3}};
  Tracker tracker(camera, {});
  for (int frame = 0; frame <= 4; ++frame) {
    const SyntheticScene scene = tag_scene(camera, {60.0 + 2 * frame, 55}, 70, {20, 25, 40}, frame);
    expect_tracked(scene, tracker.track(render(scene).luma(), frame * kFrame_s), 0.05, "frame " + std::to_string(frame));
  }
}

TEST(Stability, PrincipalPointOffCentre) {
  CameraModel camera = long_lens();
  camera.cx_px = 30;
  camera.cy_px = 180;
  Tracker tracker(camera, {});
  const SyntheticScene scene = tag_scene(camera, {140, 90}, 80, {30, 10, 0});
  const TagObservation seen = tracker.track(render(scene).luma(), 0);
  expect_tracked(scene, seen, 0.05, "");
  EXPECT_LT(turn_between_deg(seen.camera_from_tag, scene.tags[0].camera_from_tag), 0.15);
}

TEST(Stability, PortraitFootage) {
  const CameraModel camera{200, 320, 900, 900, 99.5, 159.5, {}};
  Tracker tracker(camera, {});
  const SyntheticScene scene = tag_scene(camera, {90, 230}, 80, {-30, 20, 100});
  expect_tracked(scene, tracker.track(render(scene).luma(), 0), 0.05, "");
}

/// Rows are read one after the other while the tag moves 8 px a frame: what is left is the shear that no pose explains.
TEST(Stability, RollingShutter) {
  constexpr double kMotionPx = 8;
  Tracker tracker(long_lens(), {});
  for (int frame = 0; frame <= 2; ++frame) {
    SyntheticFrame image;
    const auto at = [&](double share) {
      return tag_scene(long_lens(), {90 + kMotionPx * (frame + share), 100}, 80, {30, 10, 0}, frame);
    };
    constexpr int kBands = 10;
    for (int band = 0; band < kBands; ++band) {
      const SyntheticFrame part = render(at((band + 0.5) / kBands - 0.5));
      if (band == 0) image = part;
      const auto from = static_cast<std::ptrdiff_t>(band * 20 * image.width_px),
                 size = static_cast<std::ptrdiff_t>(20 * image.width_px);
      std::copy_n(part.codes.begin() + from, size, image.codes.begin() + from);
    }
    // The tag is 80 of 200 rows high, so its ends are off by a fifth of the motion either way.
    expect_tracked(at(0), tracker.track(image.luma(), frame * kFrame_s), kMotionPx / 5, "frame " + std::to_string(frame));
  }
}

TEST(Stability, ExposureJumpsBetweenTwoFrames) {
  Tracker tracker(long_lens(), {});
  double stops = 1;
  for (int frame = 0; frame <= 6; ++frame) {
    SyntheticScene scene = tag_scene(long_lens(), {110.0 + 3 * frame, 100}, 80, {30, 10, 0}, frame);
    stops = frame % 2 == 0 ? 1 : 0.2;
    for (double* light : {&scene.white_linear, &scene.black_linear, &scene.background_linear}) *light *= stops;
    const TagObservation seen = tracker.track(render(scene).luma(), frame * kFrame_s);
    expect_tracked(scene, seen, 0.06, "frame " + std::to_string(frame));
    ASSERT_TRUE(seen.appearance);
    EXPECT_NEAR(seen.appearance->white_linear, scene.white_linear, 0.03 * scene.white_linear);
  }
}

class AtRate : public ::testing::TestWithParam<double> {};

TEST_P(AtRate, TheSameSwingIsFollowed) {
  Tracker tracker(long_lens(), {});
  const double rate = GetParam();
  const int frames = static_cast<int>(0.3 * rate);
  for (int frame = 0; frame <= frames; ++frame) {
    const double t = frame / rate;
    const SyntheticScene scene = tag_scene(long_lens(), {120 + 40 * std::sin(5 * t), 100 + 15 * std::sin(7 * t)}, 70,
                                           {25 + 20 * std::sin(4 * t), 15, 60 * t}, frame);
    expect_tracked(scene, tracker.track(render(scene).luma(), t), 0.06, std::to_string(t) + " s");
  }
}

INSTANTIATE_TEST_SUITE_P(Stability, AtRate, ::testing::Values(12.0, 120.0));

TEST(Stability, EmptyFramesAreLostAndChangeNothing) {
  for (const int code : {0, 128, 255}) {
    Tracker tracker(long_lens(), {});
    SyntheticFrame empty{240, 200, {}, std::vector<std::uint8_t>(240 * 200, static_cast<std::uint8_t>(code))};
    EXPECT_EQ(tracker.track(empty.luma(), 0).state, TrackState::lost);
    const SyntheticScene scene = tag_scene(long_lens(), {120, 100}, 80, {30, 10, 0});
    expect_tracked(scene, tracker.track(render(scene).luma(), kFrame_s), 0.06, "after code " + std::to_string(code));
  }
}

TEST(Stability, ARepeatedFrameGivesTheSamePose) {
  Tracker tracker(long_lens(), {});
  const SyntheticScene scene = tag_scene(long_lens(), {120, 100}, 80, {30, 10, 0});
  const SyntheticFrame frame = render(scene);
  const TagObservation first = tracker.track(frame.luma(), 1.0);
  for (const double time_s : {1.0, 1.0, 1.5}) {
    const TagObservation again = tracker.track(frame.luma(), time_s);
    ASSERT_EQ(again.state, TrackState::tracking);
    // The second look starts nearer and may choose other pixels, so not the same bits; a third of what noise moves it by.
    EXPECT_LT(rms_distance(again.corners_px, first.corners_px), 0.004);
  }
}

TEST(Stability, ACutToAnotherSceneIsFollowedAtOnce) {
  Tracker tracker(long_lens(), {});
  for (int frame = 0; frame < 3; ++frame) {
    const SyntheticScene scene = tag_scene(long_lens(), {70, 80}, 60, {30, 10, 0}, frame);
    expect_tracked(scene, tracker.track(render(scene).luma(), frame * kFrame_s), 0.06, "before");
  }
  const SyntheticScene other = tag_scene(long_lens(), {160, 120}, 75, {-35, 20, 140});
  expect_tracked(other, tracker.track(render(other).luma(), 3 * kFrame_s), 0.06, "after");
}

TEST(Stability, ACutToASceneWithoutTheTagIsNotHeldOn) {
  Tracker tracker(long_lens(), {});
  const SyntheticScene scene = tag_scene(long_lens(), {120, 100}, 80, {30, 10, 0});
  tracker.track(render(scene).luma(), 0);
  SyntheticScene another = scene;  // another print in the very same place
  another.tags[0].target.id = 100;
  EXPECT_EQ(tracker.track(render(another).luma(), kFrame_s).state, TrackState::coasting);
  EXPECT_EQ(tracker.track(render(another).luma(), 10 * kFrame_s).state, TrackState::lost);
}

/// A board of two families, of which either tag is enough.
TEST(Stability, FamiliesMixed) {
  const RigidTransform tag_from_this{glm::dmat3(1.0), {0.11, 0, 0}};
  TagTarget board;
  board.bundle.push_back({{"tag25h9", 3, 0.07}, tag_from_this});
  SyntheticScene both = tag_scene(long_lens(), {70, 100}, 70, {20, 15, 0});
  both.paper_margin_cells = 0.6;
  both.tags.push_back({{{"tag25h9", 3, 0.07}, {}}, both.tags[0].camera_from_tag * tag_from_this});
  SyntheticScene second = both;
  second.tags.erase(second.tags.begin());
  Tracker tracker(long_lens(), board);
  expect_tracked(both, tracker.track(render(both).luma(), 0), 0.06, "both");
  const TagObservation alone = Tracker(long_lens(), board).track(render(second).luma(), 0);
  ASSERT_EQ(alone.state, TrackState::tracking);
  EXPECT_LT(corner_error_px(both, alone), 0.3) << "carried over from the neighbour";
}

}  // namespace
}  // namespace catchlight::tracking
