// Both poses of a square from exact and from disturbed corners; corners come from cv::projectPoints.
#include "tracking/pose/planar_pose.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/rigid_transform.hpp"
#include "tests/support/pose_error.hpp"
#include "tests/support/synthetic_tag.hpp"

#include <gtest/gtest.h>

namespace catchlight::tracking {
namespace {

SyntheticTag tag_at(const RigidTransform& camera_from_tag, double size_m = 0.08) {
  SyntheticTag tag;
  tag.target.size_m = size_m;
  tag.camera_from_tag = camera_from_tag;
  return tag;
}

TEST(PlanarPose, ExactCornersGiveTheExactPose) {
  for (const CameraModel& camera : {plain_camera(), distorted_camera()})
    for (const glm::dvec3& turn_deg :
         {glm::dvec3(35, 0, 0), glm::dvec3(-20, 40, 100), glm::dvec3(10, -60, -170), glm::dvec3(75, 0, 30)}) {
      const SyntheticTag tag = tag_at(tag_pose(camera, {260, 200}, 0.5, turn_deg));
      const auto poses = planar_poses(camera, true_corners_px(camera, tag), 0.08);
      ASSERT_FALSE(poses.empty());
      EXPECT_LT(poses[0].reprojection_rms_px, 1e-5);
      EXPECT_LT(turn_between_deg(poses[0].camera_from_tag, tag.camera_from_tag), 1e-3);
      EXPECT_LT(glm::distance(poses[0].camera_from_tag.translation_m, tag.camera_from_tag.translation_m), 1e-6);
    }
}

TEST(PlanarPose, UprightTagsAreNotSingular) {
  // Upright, upside down and on its sides: the rotation is exactly half a turn, where rotation vectors change their sign.
  for (const double roll_deg : {0.0, 90.0, 180.0, -90.0, 45.0, 135.0})
    for (const double tilt_deg : {30.0, 45.0, 60.0}) {
      const SyntheticTag tag = tag_at(tag_pose(plain_camera(), {320, 240}, 0.8, {0, tilt_deg, roll_deg}));
      const auto poses = planar_poses(plain_camera(), true_corners_px(plain_camera(), tag), 0.08);
      ASSERT_EQ(poses.size(), 2u) << roll_deg << ", " << tilt_deg;
      EXPECT_LT(turn_between_deg(poses[0].camera_from_tag, tag.camera_from_tag), 1e-3) << roll_deg << ", " << tilt_deg;
      EXPECT_GT(turn_between_deg(poses[1].camera_from_tag, tag.camera_from_tag), tilt_deg) << roll_deg << ", " << tilt_deg;
    }
}

TEST(PlanarPose, TheOtherPoseIsTheMirroredTiltAndFitsWorse) {
  const SyntheticTag tag = tag_at(tag_pose(plain_camera(), {319.5, 239.5}, 0.8, {0, 30, 0}));
  const auto poses = planar_poses(plain_camera(), true_corners_px(plain_camera(), tag), 0.08);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_GT(poses[1].reprojection_rms_px, 0.1);
  // In the middle of the image, the false pose leans the other way by about as much.
  const SyntheticTag mirrored = tag_at(tag_pose(plain_camera(), {319.5, 239.5}, 0.8, {0, -30, 0}));
  EXPECT_LT(turn_between_deg(poses[1].camera_from_tag, mirrored.camera_from_tag), 3);
}

TEST(PlanarPose, AFrontalTagHasOnePose) {
  const SyntheticTag tag = tag_at(tag_pose(plain_camera(), {319.5, 239.5}, 0.5, {0, 0, 20}));
  const auto poses = planar_poses(plain_camera(), true_corners_px(plain_camera(), tag), 0.08);
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_LT(turn_between_deg(poses[0].camera_from_tag, tag.camera_from_tag), 0.1);
}

TEST(PlanarPose, ScalesWithTheTag) {
  // A tag k times as large, k times as far away, looks the same.
  const Quad corners = true_corners_px(plain_camera(), tag_at(tag_pose(plain_camera(), {200, 300}, 0.5, {30, 20, 10})));
  const auto small = planar_poses(plain_camera(), corners, 0.08), large = planar_poses(plain_camera(), corners, 0.8);
  ASSERT_EQ(small.size(), large.size());
  EXPECT_LT(turn_between_deg(small[0].camera_from_tag, large[0].camera_from_tag), 1e-4);
  EXPECT_NEAR(large[0].camera_from_tag.translation_m.z, 10 * small[0].camera_from_tag.translation_m.z, 1e-6);
}

TEST(PlanarPose, RefinementReachesAMinimumOfTheReprojectionError) {
  const SyntheticTag tag = tag_at(tag_pose(plain_camera(), {300, 200}, 0.6, {40, 15, 20}));
  Quad corners = true_corners_px(plain_camera(), tag);
  corners[1] += glm::dvec2(0.2, -0.1);
  corners[3] += glm::dvec2(-0.05, 0.15);
  const auto poses = planar_poses(plain_camera(), corners, 0.08);
  ASSERT_FALSE(poses.empty());
  for (int axis = 0; axis < 3; ++axis)
    for (const double step : {-1e-4, 1e-4}) {
      RigidTransform moved = poses[0].camera_from_tag;
      moved.translation_m[axis] += step;
      EXPECT_GT(rms_distance(true_corners_px(plain_camera(), tag_at(moved)), corners), poses[0].reprojection_rms_px);
      glm::dvec3 turn_deg(0);
      turn_deg[axis] = 1000 * step;
      RigidTransform turned = poses[0].camera_from_tag;
      turned.rotation = turned.rotation * glm::transpose(tag_pose(plain_camera(), {}, 1, {}).rotation) *
                        tag_pose(plain_camera(), {}, 1, turn_deg).rotation;
      EXPECT_GT(rms_distance(true_corners_px(plain_camera(), tag_at(turned)), corners), poses[0].reprojection_rms_px);
    }
}

TEST(PlanarPose, AlwaysShowsThePrintedFace) {
  // The corners of a tag seen from behind run the other way round: no pose in front of the camera explains them.
  const SyntheticTag tag = tag_at(tag_pose(plain_camera(), {300, 200}, 0.6, {20, 15, 20}));
  Quad corners = true_corners_px(plain_camera(), tag);
  std::swap(corners[0], corners[1]);
  std::swap(corners[2], corners[3]);
  for (const auto& pose : planar_poses(plain_camera(), corners, 0.08)) {
    const RigidTransform& p = pose.camera_from_tag;
    EXPECT_GT(p.translation_m.z, 0);
    EXPECT_LT(glm::dot(p.rotation[2], p.translation_m), 0);
  }
}

TEST(PlanarPose, DegenerateCornersGiveNoPoseOrAFiniteOne) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Quad in_a_line{{{100, 100}, {150, 100}, {200, 100}, {250, 100}}};
  const Quad one_point{{{100, 100}, {100, 100}, {100, 100}, {100, 100}}};
  const Quad two_alike{{{100, 100}, {150, 100}, {150, 100}, {100, 150}}};
  const Quad not_a_number{{{nan, 100}, {150, 100}, {150, 150}, {100, 150}}};
  for (const Quad& corners : {in_a_line, one_point, two_alike, not_a_number})
    for (const auto& pose : planar_poses(plain_camera(), corners, 0.08)) {
      EXPECT_TRUE(std::isfinite(pose.reprojection_rms_px));
      EXPECT_TRUE(std::isfinite(pose.camera_from_tag.translation_m.z));
    }
}

}  // namespace
}  // namespace catchlight::tracking
