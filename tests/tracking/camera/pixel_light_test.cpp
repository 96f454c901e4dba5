// The mean light of squares on the tag's plane, against the pixels that their points project to one by one.
#include <gtest/gtest.h>

#include <random>

#include "catchlight/projection.hpp"
#include "tests/support/synthetic_tag.hpp"
#include "tests/tracking/camera/light_fixture.hpp"

namespace catchlight::tracking {
namespace {

Light random_light(const CameraModel& camera) {
  Light light{camera.width_px, camera.height_px, {}};
  std::mt19937 random(1);
  std::uniform_real_distribution<float> value(0, 1);
  for (int i = 0; i < camera.width_px * camera.height_px; ++i)
    light.rgb.emplace_back(value(random), value(random), value(random));
  return light;
}

class SquareLightOf : public ::testing::TestWithParam<CameraModel> {};

TEST_P(SquareLightOf, IsTheMeanOfTheNearestPixels) {
  const CameraModel& camera = GetParam();
  const Light light = random_light(camera);
  const PixelLight view = light.view(0.9f);
  const RigidTransform pose = tag_pose(camera, {300, 250}, 0.4, {35, -20, 15});
  for (const int across : {1, 5, 8, 12}) {
    const PlaneSquare square{{-0.03, 0.01}, 0.04};
    glm::dvec3 sum(0);
    glm::ivec3 clipped(0);
    for (int i = 0; i < across * across; ++i) {
      const glm::dvec2 share = (glm::dvec2(i % across, i / across) + 0.5) / static_cast<double>(across);
      const glm::dvec2 px = project_px(camera, pose * glm::dvec3(square.low_m + square.side_m * share, 0)).value();
      const glm::vec3 rgb = light.rgb[static_cast<std::size_t>(std::lround(px.y) * camera.width_px + std::lround(px.x))];
      sum += glm::dvec3(rgb);
      for (int c = 0; c < 3; ++c) clipped[c] += rgb[c] >= 0.9f;
    }
    const auto seen = square_light(view, camera, pose, square, across);
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->samples, across * across);
    EXPECT_EQ(seen->clipped, clipped);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen->mean[c], sum[c] / (across * across), 1e-6);
  }
}

TEST_P(SquareLightOf, IsNotKnownWhereThePictureEnds) {
  const CameraModel& camera = GetParam();
  const Light light = random_light(camera);
  const RigidTransform pose = tag_pose(camera, {0, 250}, 0.4, {0, 0, 0});
  EXPECT_FALSE(square_light(light.view(), camera, pose, {{-0.1, -0.02}, 0.12}, 8)) << "most of it";
  EXPECT_TRUE(square_light(light.view(), camera, pose, {{0.01, -0.02}, 0.04}, 8));
  RigidTransform behind = pose;
  behind.translation_m.z = -0.4;
  EXPECT_FALSE(square_light(light.view(), camera, behind, {{0.01, -0.02}, 0.04}, 8));
}

INSTANTIATE_TEST_SUITE_P(Cameras, SquareLightOf, ::testing::Values(plain_camera(), distorted_camera()),
                         [](const auto& test) { return test.param.has_distortion() ? "distorted" : "plain"; });

}  // namespace
}  // namespace catchlight::tracking
