// The remembered pixels of a lens against the lens itself, and their slopes against finite differences.
#include "tracking/refinement/ideal_pixels.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/projection.hpp"
#include "tests/support/finite_differences.hpp"
#include "tests/support/synthetic_tag.hpp"

#include <gtest/gtest.h>

namespace catchlight::tracking {
namespace {

using tests::expect_near;
using tests::finite_differences;

/// Focal lengths that differ, so that a Jacobian cannot mix up its axes unnoticed.
CameraModel wide_camera() {
  CameraModel camera = distorted_camera();
  camera.fy_px = 640;
  return camera;
}

TEST(IdealPixels, AreTheUndistortedOnes) {
  const CameraModel camera = wide_camera();
  IdealPixels pixels(camera);
  for (const int y : {0, 15, 16, 17, 240, camera.height_px - 1})
    for (const int x : {0, 15, 16, 333, camera.width_px - 1}) {
      const auto seen = pixels.at(x, y);
      const auto expected_px = undistort_px(camera, {x, y});
      ASSERT_EQ(seen.has_value(), expected_px.has_value());
      EXPECT_EQ(seen->ideal_px, *expected_px) << x << ", " << y;
      const glm::dmat2 slope = finite_differences({x, y}, [&](const glm::dvec2& px) { return undistort_px(camera, px).value(); });
      expect_near(seen->ideal_per_seen, slope, 1e-5);
    }
}

TEST(IdealPixels, AskedTwiceAnswerTheSame) {
  IdealPixels pixels(wide_camera());
  const auto first = pixels.at(100, 70);
  pixels.at(500, 400);
  EXPECT_EQ(pixels.at(100, 70)->ideal_px, first->ideal_px);
}

TEST(IdealPixels, OfAPinholeAreThePixelsThemselves) {
  IdealPixels pixels(plain_camera());
  EXPECT_EQ(pixels.at(639, 479)->ideal_px, glm::dvec2(639, 479));
  expect_near(pixels.at(639, 479)->ideal_per_seen, glm::dmat2(1.0), 0);
  EXPECT_EQ(ideal_pixel(plain_camera(), {1.5, -2.25})->ideal_px, glm::dvec2(1.5, -2.25));
}

TEST(IdealPixels, AnImageWhoseSizeIsNoMultipleOfTheTilesIsCoveredToItsEdge) {
  CameraModel camera = wide_camera();
  camera.width_px = 37, camera.height_px = 19, camera.cx_px = 18, camera.cy_px = 9;
  IdealPixels pixels(camera);
  EXPECT_EQ(pixels.at(36, 18)->ideal_px, *undistort_px(camera, {36, 18}));
}

TEST(IdealPixels, AreEmptyWhereTheLensModelFoldsBack) {
  // With k1 = -0.5 alone nothing is seen beyond 0.544 focal lengths from the centre.
  CameraModel camera = plain_camera();
  camera.fx_px = camera.fy_px = 500;
  camera.distortion[0] = -0.5;
  IdealPixels pixels(camera);
  EXPECT_TRUE(pixels.at(319 + 250, 240));
  EXPECT_FALSE(pixels.at(319 + 300, 240));
  EXPECT_FALSE(pixels.at(0, 0));
}

}  // namespace
}  // namespace catchlight::tracking
