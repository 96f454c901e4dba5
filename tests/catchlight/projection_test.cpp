// The projection against OpenCV's own, which shares no code with it, and against itself as an inverse pair.
#include "catchlight/projection.hpp"
#include "tests/support/finite_differences.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <random>

namespace catchlight {
namespace {

using tests::expect_near;
using tests::finite_differences;

/// 640x480, 600 px focal length, no distortion.
CameraModel plain_camera() {
  return {640, 480, 600, 600, 319.5, 239.5, {}};
}

/// The barrel distortion and slight decentring of a cheap wide lens (rational model, all eight terms). Focal lengths that differ,
/// so that a Jacobian cannot mix up its axes unnoticed.
CameraModel wide_camera() {
  return {640, 480, 520, 640, 331.2, 236.7, {-0.31, 0.12, 0.0011, -0.0007, -0.02, 0.01, 0.005, 0.001}};
}

/// Barrel distortion with a limit: 1.6 focal lengths from the axis it squeezes ten to one.
CameraModel barrel_camera() {
  return {640, 480, 610, 605, 322.25, 236.5, {-0.32, 0.12, 0.001, -0.002, -0.02, 0, 0, 0}};
}

glm::dvec2 pixel_by_opencv(const CameraModel& camera, const glm::dvec3& point) {
  const cv::Matx33d matrix(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  const std::vector<double> distortion(camera.distortion.begin(), camera.distortion.end());
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(std::vector<cv::Point3d>{{point.x, point.y, point.z}}, cv::Vec3d(), cv::Vec3d(), matrix, distortion, pixels);
  return {pixels[0].x, pixels[0].y};
}

TEST(Projection, IsOpenCvs) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> xy(-0.5, 0.5), z(0.5, 3);
  for (const CameraModel& camera : {plain_camera(), wide_camera(), barrel_camera()}) {
    const DistortionLimit limit = distortion_limit(camera);
    for (int i = 0; i < 200; ++i) {
      const double depth = z(random);
      const glm::dvec3 point(xy(random) * depth, xy(random) * depth, depth);
      const glm::dvec2 expected = pixel_by_opencv(camera, point);
      for (const auto& seen : {project_px(camera, point), project_px(camera, point, &limit)}) {
        ASSERT_TRUE(seen);
        EXPECT_NEAR(seen->x, expected.x, 1e-9);
        EXPECT_NEAR(seen->y, expected.y, 1e-9);
      }
    }
  }
}

TEST(Projection, UndistortingInvertsDistortingOverTheWholeImage) {
  const CameraModel camera = wide_camera();
  for (int y = 0; y < camera.height_px; y += 20)
    for (int x = 0; x < camera.width_px; x += 20) {
      const auto ideal = undistort_px(camera, {x, y});
      ASSERT_TRUE(ideal) << x << ", " << y;
      const glm::dvec2 back = distort_px(camera, *ideal);
      EXPECT_NEAR(back.x, x, 1e-8);
      EXPECT_NEAR(back.y, y, 1e-8);
    }
}

TEST(Projection, WithoutDistortionChangesNothing) {
  const glm::dvec2 anywhere(-12.25, 700.5);
  EXPECT_EQ(distort_px(plain_camera(), anywhere), anywhere);
  EXPECT_EQ(undistort_px(plain_camera(), anywhere), anywhere);
}

TEST(Projection, HasNoInverseWhereTheModelFoldsBack) {
  // With k1 = -0.5 alone, r(1 - r²/2) never exceeds 0.544: nothing is seen 0.6 focal lengths from the centre.
  CameraModel camera = plain_camera();
  camera.distortion[0] = -0.5;
  EXPECT_TRUE(undistort_px(camera, {camera.cx_px + 0.5 * camera.fx_px, camera.cy_px}));
  EXPECT_FALSE(undistort_px(camera, {camera.cx_px + 0.6 * camera.fx_px, camera.cy_px}));
}

TEST(Projection, SeesNothingBehindTheCamera) {
  EXPECT_FALSE(project_px(plain_camera(), {0, 0, -1}));
  EXPECT_FALSE(project_px(plain_camera(), {0.1, 0, 0}));
}

TEST(Projection, ItsJacobianIsTheSlopeOfDistorting) {
  const CameraModel camera = wide_camera();
  for (double y = -60; y < 560; y += 77)
    for (double x = -80; x < 720; x += 91)
      expect_near(distortion_jacobian(camera, {x, y}),
                  finite_differences({x, y}, [&](const glm::dvec2& px) { return distort_px(camera, px); }), 1e-6);
}

TEST(Projection, WithoutDistortionItsJacobianIsTheIdentity) {
  expect_near(distortion_jacobian(plain_camera(), {12.5, 400}), glm::dmat2(1.0), 1e-15);
}

TEST(ContinuedProjection, NeitherFoldsBackNorBreaksBeyondItsLimit) {
  const CameraModel camera = barrel_camera();
  const DistortionLimit limit = distortion_limit(camera);
  double last = 0;
  for (double r = 0.001; r < 100; r *= 1.01) {
    const double now = distorted(camera, limit, {r, 0, 1}).x;
    EXPECT_GT(now, last) << "at radius " << r;
    last = now;
  }
  const glm::dvec3 inside = distorted(camera, limit, {limit.radius - 1e-9, 0, 1}),
                   outside = distorted(camera, limit, {limit.radius + 1e-9, 0, 1});
  EXPECT_NEAR(inside.x, outside.x, 1e-8);
}

TEST(ContinuedProjection, PointsBehindTheCameraStayFinite) {
  const CameraModel camera = barrel_camera();
  for (const glm::dvec3& point : {glm::dvec3(0, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(1, 2, 0), glm::dvec3(-1, 0.5, -0.3)}) {
    const glm::dvec3 result = distorted(camera, distortion_limit(camera), point);
    EXPECT_TRUE(std::isfinite(result.x) && std::isfinite(result.y)) << point.x << " " << point.y << " " << point.z;
    EXPECT_EQ(result.z, point.z);
  }
}

/// From the middle of the field to far beyond its limit.
TEST(ContinuedProjection, HasAnInverseEverywhere) {
  const CameraModel camera = barrel_camera();
  const DistortionLimit limit = distortion_limit(camera);
  for (double y = -3000; y <= 3000; y += 200)
    for (double x = -3000; x <= 3000; x += 200) {
      const auto ideal = undistort_px(camera, {x, y}, &limit);
      ASSERT_TRUE(ideal) << x << ", " << y;
      EXPECT_LT(glm::distance(distort_px(camera, *ideal, &limit), glm::dvec2(x, y)), 1e-8) << x << ", " << y;
    }
}

TEST(ContinuedProjection, TakesPointsWhereItTakesTheirPixels) {
  const CameraModel camera = barrel_camera();
  const DistortionLimit limit = distortion_limit(camera);
  for (const double slope : {0.0, 0.3, 1.2, 3.0, 40.0}) {
    const glm::dvec3 point(slope * 0.6, slope * 0.8, 1), seen = distorted(camera, limit, 2.0 * point);
    const auto px = project_px(camera, point, &limit);
    EXPECT_NEAR((px->x - camera.cx_px) / camera.fx_px, seen.x / seen.z, 1e-12 * (1 + slope));
    EXPECT_NEAR((px->y - camera.cy_px) / camera.fy_px, seen.y / seen.z, 1e-12 * (1 + slope));
  }
}

}  // namespace
}  // namespace catchlight
