#include "render/cpu/surface/pixel_rays.hpp"

#include <gtest/gtest.h>

namespace catchlight::render {
namespace {

CameraModel camera_of(const std::array<double, 8>& distortion) {
  return {.width_px = 160, .height_px = 120, .fx_px = 150, .fy_px = 140, .cx_px = 81.3, .cy_px = 57.9, .distortion = distortion};
}

const std::array<double, 8> kLenses[] = {{},
                                         {-0.3, 0.1, 0.002, -0.001, 0, 0, 0, 0},
                                         {-0.9, 0.9, 0.01, -0.01, 0, 0, 0, 0},
                                         {0.6, 0.4, -0.02, 0.01, 0.1, 0.05, 0.01, 0}};

TEST(PixelRays, AreSeenAtThePixelsThatTheyComeFrom) {
  for (const auto& lens : kLenses) {
    const CameraModel camera = camera_of(lens);
    const DistortionLimit limit = distortion_limit(camera);
    PixelRays rays;
    rays.set_camera(camera, limit);
    for (int y = 0; y < camera.height_px; y += 7)
      for (int x = 0; x < camera.width_px; x += 9) {
        const auto seen = project_px(camera, glm::dvec3(glm::dvec2(rays.at(x, y)), 1), &limit);
        ASSERT_TRUE(seen);
        EXPECT_LT(glm::distance(*seen, glm::dvec2(x, y)), 1e-4) << x << ", " << y << " " << lens[0];
      }
  }
}

TEST(PixelRays, AreKnownBeyondThePicturesLastPixels) {
  for (const auto& lens : kLenses) {
    const CameraModel camera = camera_of(lens);
    const DistortionLimit limit = distortion_limit(camera);
    PixelRays rays;
    rays.set_camera(camera, limit);
    for (int beyond = 0; beyond < PixelRays::kBeyond; ++beyond)
      for (const glm::ivec2& pixel : {glm::ivec2(60, camera.height_px + beyond), {camera.width_px + beyond, 40}}) {
        const auto seen = project_px(camera, glm::dvec3(glm::dvec2(rays.at(pixel.x, pixel.y)), 1), &limit);
        ASSERT_TRUE(seen);
        EXPECT_LT(glm::distance(*seen, glm::dvec2(pixel)), 1e-4) << pixel.x << ", " << pixel.y << " " << lens[0];
      }
  }
}

TEST(PixelRays, AreLinearWithinAPixelToAFiftiethOfIt) {
  for (const auto& lens : kLenses) {
    const CameraModel camera = camera_of(lens);
    const DistortionLimit limit = distortion_limit(camera);
    PixelRays rays;
    rays.set_camera(camera, limit);
    for (int y = 0; y < camera.height_px; y += 7)
      for (int x = 0; x < camera.width_px; x += 9)
        for (const glm::vec2& offset : {glm::vec2(-0.5f, 0.5f), {0.375f, -0.125f}, {0.5f, 0.5f}}) {
          const auto seen = project_px(camera, glm::dvec3(glm::dvec2(rays.at(x, y, offset)), 1), &limit);
          ASSERT_TRUE(seen);
          EXPECT_LT(glm::distance(*seen, glm::dvec2(x, y) + glm::dvec2(offset)), 0.02) << x << ", " << y << " " << lens[0];
        }
  }
}

TEST(PixelRays, FollowTheCamera) {
  PixelRays rays;
  CameraModel camera = camera_of(kLenses[1]);
  rays.set_camera(camera, distortion_limit(camera));
  camera.fx_px *= 2;
  rays.set_camera(camera, distortion_limit(camera));
  const DistortionLimit limit = distortion_limit(camera);
  const auto seen = project_px(camera, glm::dvec3(glm::dvec2(rays.at(100, 20)), 1), &limit);
  EXPECT_LT(glm::distance(seen.value(), glm::dvec2(100, 20)), 1e-4);
  camera.distortion = {};
  rays.set_camera(camera, distortion_limit(camera));
  EXPECT_NEAR(rays.at(100, 20).x, (100 - 81.3) / 300, 1e-6) << "no table is left of the lens before";
}

}  // namespace
}  // namespace catchlight::render
