// The camera frame taken to clip space, against OpenCV's own projection.
#include "render/camera/clip_from_camera.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/rigid_transform.hpp"

#include <gtest/gtest.h>
#include <vector>

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <random>

namespace catchlight::render {
namespace {

CameraModel camera_with(const std::array<double, 8>& distortion) {
  return {
      .width_px = 640, .height_px = 480, .fx_px = 610, .fy_px = 605, .cx_px = 322.25, .cy_px = 236.5, .distortion = distortion};
}

const std::array<double, 8> kBarrel{-0.32, 0.12, 0.001, -0.002, -0.02, 0, 0, 0};
const std::array<double, 8> kRational{8.1, 3.2, -0.0004, 0.0003, 0.15, 8.4, 5.9, 0.93};

glm::dvec2 pixel_by_opencv(const CameraModel& camera, const glm::dvec3& point) {
  const cv::Matx33d matrix(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  const std::vector<double> distortion(camera.distortion.begin(), camera.distortion.end());
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(std::vector<cv::Point3d>{{point.x, point.y, point.z}}, cv::Vec3d(), cv::Vec3d(), matrix, distortion, pixels);
  return {pixels[0].x, pixels[0].y};
}

glm::dvec2 pixel_by_clip(const CameraModel& camera, const glm::dvec3& point) {
  const glm::dvec4 clip = clip_from_camera(camera, 0.01) * glm::dvec4(distorted(camera, distortion_limit(camera), point), 1.0);
  return (glm::dvec2(clip) / clip.w + 1.0) / 2.0 * glm::dvec2(camera.width_px, camera.height_px) - 0.5;
}

TEST(ClipFromCamera, ProjectsAsOpenCvDoes) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> xy(-0.5, 0.5), z(0.5, 3);
  for (const auto& distortion : {std::array<double, 8>{}, kBarrel, kRational}) {
    const CameraModel camera = camera_with(distortion);
    for (int i = 0; i < 200; ++i) {
      const double depth = z(random);
      const glm::dvec3 point(xy(random) * depth, xy(random) * depth, depth);
      // Both are doubles: only rounding separates them.
      EXPECT_LT(glm::distance(pixel_by_clip(camera, point), pixel_by_opencv(camera, point)), 1e-9);
    }
  }
}

TEST(ClipFromCamera, DepthIsReversedAndHasNoFarEnd) {
  const glm::dmat4 clip = clip_from_camera(camera_with({}), 0.01);
  const auto depth = [&](double z) {
    const glm::dvec4 p = clip * glm::dvec4(0, 0, z, 1);
    return p.z / p.w;
  };
  EXPECT_DOUBLE_EQ(depth(0.01), 1.0);
  EXPECT_DOUBLE_EQ(depth(1.0), 0.01);
  EXPECT_GT(depth(1e6), 0.0);
}

TEST(VisibleRect, HoldsEveryProjectionOfTheBox) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> angle(-3, 3), share(0, 1), shift(-0.3, 0.3), depth(0.4, 2);
  for (const auto& distortion : {std::array<double, 8>{}, kBarrel, kRational}) {
    const CameraModel camera = camera_with(distortion);
    for (int i = 0; i < 100; ++i) {
      cv::Matx33d r;
      cv::Rodrigues(cv::Vec3d(angle(random), angle(random), angle(random)), r);
      RigidTransform camera_from_tag;
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) camera_from_tag.rotation[column][row] = r(row, column);
      camera_from_tag.translation_m = {shift(random), shift(random), depth(random)};
      const glm::dvec3 low(-0.1, -0.05, 0), high(0.1, 0.08, 0.12);
      const PixelRect rect =
          visible_rect(camera, distortion_limit(camera), camera_from_tag, {glm::vec3(low), glm::vec3(high)}, 0.001);
      for (int k = 0; k < 50; ++k) {
        const glm::dvec3 p = camera_from_tag * glm::mix(low, high, glm::dvec3(share(random), share(random), share(random)));
        const glm::dvec2 pixel = pixel_by_clip(camera, p);
        if (pixel.x < 0 || pixel.y < 0 || pixel.x > 639 || pixel.y > 479) continue;
        EXPECT_TRUE(pixel.x >= rect.x && pixel.x < rect.x + rect.width && pixel.y >= rect.y && pixel.y < rect.y + rect.height);
      }
    }
  }
}

TEST(VisibleRect, IsEmptyBehindTheCameraAndWholeAcrossItsPlane) {
  const CameraModel camera = camera_with({});
  const Bounds box{glm::vec3(-0.1f), glm::vec3(0.1f)};
  RigidTransform behind, across;
  behind.translation_m = {0, 0, -1};
  EXPECT_TRUE(visible_rect(camera, distortion_limit(camera), behind, box, 0.001).empty());
  EXPECT_EQ(visible_rect(camera, distortion_limit(camera), across, box, 0.001), (PixelRect{0, 0, 640, 480}));
}

}  // namespace
}  // namespace catchlight::render
