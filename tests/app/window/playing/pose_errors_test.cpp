// The track's own doubt beside the true error.
#include "app/window/playing/pose_errors.hpp"

#include <gtest/gtest.h>

#include "tests/support/synthetic_tag.hpp"

namespace catchlight::app {
namespace {

const CameraModel kCamera = tracking::plain_camera();
const RigidTransform kPose = tracking::tag_pose(kCamera, {320, 240}, 0.5, {20, 0, 0});

TrackRow row(std::int64_t frame, const RigidTransform& camera_from_tag) {
  TrackRow row;
  row.frame = frame, row.found = true, row.state = TrackState::tracking;
  row.camera_from_tag = camera_from_tag;
  row.corner_sigma_px = 0.02;
  return row;
}

TEST(PoseErrors, AreMeasuredAgainstTheTruthOfTheSameFrame) {
  RigidTransform off = kPose;
  off.translation_m.x += 1e-3;
  const auto errors = pose_errors({row(4, kPose), row(5, off)}, {row(5, kPose), row(4, kPose)}, kCamera, 0.08);
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_NEAR(errors[0].off_px.value(), 0, 1e-9);
  EXPECT_EQ(errors[1].frame, 5);
  EXPECT_NEAR(errors[1].off_mm.value(), 1, 1e-9);
  EXPECT_NEAR(errors[1].off_px.value(), 1e-3 * kCamera.fx_px / 0.5, 0.02) << "as far as the tag's middle moves";
  EXPECT_NEAR(errors[1].turned_deg.value(), 0, 1e-5);
  EXPECT_EQ(errors[1].sigma_px, 0.02);
}

TEST(PoseErrors, WithoutATruthThereIsTheTracksDoubt) {
  const auto errors = pose_errors({row(0, kPose), TrackRow{}}, {}, kCamera, 0.08);
  EXPECT_FALSE(errors[0].off_px);
  EXPECT_EQ(errors[0].sigma_px, 0.02);
  EXPECT_EQ(errors[1].state, TrackState::lost);
}

}  // namespace
}  // namespace catchlight::app
