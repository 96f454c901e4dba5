// The lens model against OpenCV's own, which shares no code with it, and against itself as an inverse pair.
#include "tracking/camera/lens.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/tag.hpp"
#include "tests/support/synthetic_tag.hpp"

#include <gtest/gtest.h>

namespace catchlight::tracking {
namespace {

TEST(Lens, ProjectsAsOpenCvDoes) {
  // true_corners_px() goes through cv::projectPoints.
  const CameraModel camera = distorted_camera();
  SyntheticTag tag;
  tag.target.size_m = 0.2;
  tag.camera_from_tag = tag_pose(camera, {180, 110}, 0.5, {20, -30, 10});
  const auto expected = true_corners_px(camera, tag);
  const auto corners_m = tag_corners_m(tag.target.size_m);
  for (int i = 0; i < 4; ++i) {
    const auto seen = project_px(camera, tag.camera_from_tag * corners_m[i]);
    ASSERT_TRUE(seen);
    EXPECT_NEAR(seen->x, expected[i].x, 1e-9);
    EXPECT_NEAR(seen->y, expected[i].y, 1e-9);
  }
}

TEST(Lens, UndistortingInvertsDistortingOverTheWholeImage) {
  const CameraModel camera = distorted_camera();
  for (int y = 0; y < camera.height_px; y += 20)
    for (int x = 0; x < camera.width_px; x += 20) {
      const auto ideal = undistort_px(camera, {x, y});
      ASSERT_TRUE(ideal) << x << ", " << y;
      const glm::dvec2 back = distort_px(camera, *ideal);
      EXPECT_NEAR(back.x, x, 1e-8);
      EXPECT_NEAR(back.y, y, 1e-8);
    }
}

TEST(Lens, WithoutDistortionChangesNothing) {
  const glm::dvec2 anywhere(-12.25, 700.5);
  EXPECT_EQ(distort_px(plain_camera(), anywhere), anywhere);
  EXPECT_EQ(undistort_px(plain_camera(), anywhere), anywhere);
}

TEST(Lens, HasNoInverseWhereTheModelFoldsBack) {
  // With k1 = -0.5 alone, r(1 - r²/2) never exceeds 0.544: nothing is seen 0.6 focal lengths from the centre.
  CameraModel camera = plain_camera();
  camera.distortion[0] = -0.5;
  EXPECT_TRUE(undistort_px(camera, {camera.cx_px + 0.5 * camera.fx_px, camera.cy_px}));
  EXPECT_FALSE(undistort_px(camera, {camera.cx_px + 0.6 * camera.fx_px, camera.cy_px}));
}

TEST(Lens, SeesNothingBehindTheCamera) {
  EXPECT_FALSE(project_px(plain_camera(), {0, 0, -1}));
  EXPECT_FALSE(project_px(plain_camera(), {0.1, 0, 0}));
}

}  // namespace
}  // namespace catchlight::tracking
