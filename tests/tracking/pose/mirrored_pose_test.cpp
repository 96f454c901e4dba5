// The pose that a flat target is taken for, against closed forms.
#include "tracking/pose/mirrored_pose.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"
#include "tests/support/pose_error.hpp"
#include "tests/support/synthetic_tag.hpp"

#include <gtest/gtest.h>

namespace catchlight::tracking {
namespace {

constexpr PlanarSquare kSquare{{0, 0, 0}, 0.08};

BundledTag tag_beside(const glm::dvec3& offset_m, double size_m = 0.08) {
  BundledTag tag;
  tag.size_m = size_m;
  tag.tag_from_this.translation_m = offset_m;
  return tag;
}

RigidTransform in_the_middle(double distance_m, const glm::dvec3& turn_deg) {
  return tag_pose(plain_camera(), {319.5, 239.5}, distance_m, turn_deg);
}

TEST(PlanarSquare, SpansAllTagsOfAFlatBoard) {
  const auto square = planar_square({tag_beside({0, 0, 0}), tag_beside({0.2, -0.1, 0}, 0.04)});
  ASSERT_TRUE(square);
  EXPECT_NEAR(square->center_m.x, 0.09, 1e-12);   // from -0.04 to 0.22
  EXPECT_NEAR(square->center_m.y, -0.04, 1e-12);  // from -0.12 to 0.04
  EXPECT_NEAR(square->size_m, 0.26, 1e-12);
}

TEST(PlanarSquare, IsEmptyForABoardWithDepth) {
  EXPECT_FALSE(planar_square({tag_beside({0, 0, 0}), tag_beside({0.1, 0, 0.01})}));
  BundledTag tilted = tag_beside({0.1, 0, 0});
  tilted.tag_from_this.rotation = tag_pose(plain_camera(), {}, 1, {0, 20, 0}).rotation;
  EXPECT_FALSE(planar_square({tag_beside({0, 0, 0}), tilted}));
}

/// How far the other pose of a tag in the middle of the picture, tilted so, is from one tilted the other way.
double off_deg(double tilt_deg) {
  const auto other = mirrored(plain_camera(), kSquare, in_the_middle(2, {0, tilt_deg, 0}));
  return other ? turn_between_deg(other->camera_from_tag, in_the_middle(2, {0, -tilt_deg, 0})) : 360;
}

TEST(Mirrored, LeansTheOtherWay) {
  for (const double tilt_deg : {20.0, 30.0, 60.0}) EXPECT_LT(off_deg(tilt_deg), 1) << tilt_deg;
}

// Exact corners have one planar pose there; the pixels' noise may still hide which of the two is true.
TEST(Mirrored, LeansTheOtherWayWhereTheCornersAllowOnePose) {
  for (const double tilt_deg : {0.5, 1.0, 2.0}) EXPECT_LT(off_deg(tilt_deg), 1e-4) << tilt_deg;
}

TEST(Mirrored, SaysHowFarTheCornersAreOff) {
  const RigidTransform pose = in_the_middle(0.8, {0, 30, 0});
  const auto other = mirrored(plain_camera(), kSquare, pose);
  ASSERT_TRUE(other);
  SyntheticTag truth, mirror;
  truth.camera_from_tag = pose;
  mirror.camera_from_tag = other->camera_from_tag;
  truth.target.size_m = mirror.target.size_m = kSquare.size_m;
  const double apart_px = rms_distance(true_corners_px(plain_camera(), truth), true_corners_px(plain_camera(), mirror));
  EXPECT_GT(apart_px, 0.1);
  EXPECT_NEAR(other->reprojection_rms_px, apart_px, 1e-6);
}

TEST(Mirrored, DoesNotDependOnWhereTheTagLiesInTheSquare) {
  // The same square in space, described by a tag in its middle and by one beside it.
  const RigidTransform pose = in_the_middle(1, {20, 30, 10}), aside{glm::dmat3(1.0), {0.1, 0.05, 0}};
  const auto centred = mirrored(plain_camera(), kSquare, pose);
  const auto beside = mirrored(plain_camera(), {-aside.translation_m, kSquare.size_m}, pose * aside);
  ASSERT_TRUE(centred && beside);
  const RigidTransform expected = centred->camera_from_tag * aside;
  EXPECT_LT(turn_between_deg(beside->camera_from_tag, expected), 1e-4);
  EXPECT_LT(glm::distance(beside->camera_from_tag.translation_m, expected.translation_m), 1e-6);
}

TEST(Mirrored, IsEmptyWhereTheTagFacesTheCamera) {
  EXPECT_FALSE(mirrored(plain_camera(), kSquare, {in_the_middle(1, {0, 0, 20}).rotation, {0, 0, 1}}));
}

TEST(Mirrored, IsEmptyWhereACornerIsBehindTheCamera) {
  EXPECT_FALSE(mirrored(plain_camera(), kSquare, in_the_middle(0.03, {0, 80, 0})));
}

}  // namespace
}  // namespace catchlight::tracking
