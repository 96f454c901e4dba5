#include "render/cpu/mirror/cube_texture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "catchlight/error.hpp"
#include "render/probe/cube_map.hpp"

namespace catchlight::render {
namespace {

/// Six faces, one below the other.
Image faces_of(int size, const std::function<glm::vec3(int face, int x, int y)>& value) {
  Image image(size, 6 * size);
  for (int y = 0; y < 6 * size; ++y)
    for (int x = 0; x < size; ++x) {
      const glm::vec3 rgb = value(y / size, x, y % size);
      for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = rgb[c];
    }
  return image;
}

Image random_faces(int size) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> value(0, 1);
  return faces_of(size, [&](int, int, int) { return glm::vec3(value(random), value(random), value(random)); });
}

std::vector<glm::vec3> random_directions(int count) {
  std::mt19937 random(7);
  std::normal_distribution<float> normal;
  std::vector<glm::vec3> result;
  for (int i = 0; i < count; ++i) result.emplace_back(normal(random), normal(random), normal(random));
  return result;
}

TEST(CubeTexture, AConstantMapIsConstant) {
  const auto constant = [](int, int, int) { return glm::vec3(0.2f, 3, 500); };
  const CubeTexture texture({{faces_of(8, constant), faces_of(4, constant), faces_of(1, constant)}});
  for (const glm::vec3& direction : random_directions(500))
    for (const float level : {-1.0f, 0.0f, 0.3f, 1.7f, 2.0f, 9.0f})
      EXPECT_LT(glm::distance(texture.sample(direction, level), glm::vec3(0.2f, 3, 500)), 1e-3f);
}

TEST(CubeTexture, IsLinearWithinAFaceInOpenGlsOrientation) {
  constexpr int kSize = 16;
  const CubeTexture texture({{faces_of(kSize, [](int face, int x, int y) { return glm::vec3(face, x, y); })}});
  for (int face = 0; face < 6; ++face)
    for (const auto& [s, t] : {std::pair(0.0, 0.0), {-0.9, 0.4}, {0.93, -0.93}, {0.31, 0.77}}) {
      const glm::vec3 value = texture.sample(glm::vec3(3.0 * cube_direction(face, s, t)), 0);
      EXPECT_NEAR(value.x, face, 1e-5);
      EXPECT_NEAR(value.y, (0.5 * s + 0.5) * kSize - 0.5, 1e-4);
      EXPECT_NEAR(value.z, (0.5 * t + 0.5) * kSize - 0.5, 1e-4);
    }
}

TEST(CubeTexture, HasNoSeamAtTheEdgesOfFaces) {
  constexpr int kSize = 8;
  const CubeTexture texture({{random_faces(kSize)}});
  // Along all twelve edges, but for the half texel at the corners, where three faces meet and four texels do not.
  for (int axis = 0; axis < 3; ++axis)
    for (const auto& [a, b] : {std::pair(1, 1), {1, -1}, {-1, 1}, {-1, -1}})
      for (double along = -1 + 1.0 / kSize; along <= 1 - 1.0 / kSize; along += 0.01) {
        glm::vec3 edge, across(0);
        edge[axis] = static_cast<float>(along), edge[(axis + 1) % 3] = static_cast<float>(a),
        edge[(axis + 2) % 3] = static_cast<float>(b);
        across[(axis + 1) % 3] = static_cast<float>(a) * 1e-5f, across[(axis + 2) % 3] = static_cast<float>(b) * -1e-5f;
        EXPECT_LT(glm::distance(texture.sample(edge + across, 0), texture.sample(edge - across, 0)), 1e-3f) << axis << along;
      }
}

TEST(CubeTexture, ASmoothMapIsSmoothAtTheCornersToo) {
  constexpr int kSize = 32;
  const auto smooth = [](const glm::dvec3& d) { return glm::vec3(glm::dvec3(1.5) + d); };
  const CubeTexture texture(
      {{faces_of(kSize, [&](int face, int x, int y) { return smooth(cube_texel_direction(face, kSize, x, y)); })}});
  for (const glm::vec3& direction : random_directions(2000))
    EXPECT_LT(glm::distance(texture.sample(direction, 0), smooth(glm::normalize(glm::dvec3(direction)))), 0.02f);
  for (const float x : {-1.0f, 1.0f})
    for (const float y : {-1.0f, 1.0f})
      for (const float z : {-1.0f, 1.0f})
        EXPECT_LT(glm::distance(texture.sample({x, y, z}, 0), smooth(glm::normalize(glm::dvec3(x, y, z)))), 0.06f);
}

TEST(CubeTexture, LevelsAreMixedInProportion) {
  const auto level = [](float value) { return faces_of(4, [=](int, int, int) { return glm::vec3(value); }); };
  const CubeTexture texture({{level(1), level(3), level(11)}});
  EXPECT_EQ(texture.levels(), 3);
  for (const auto& [at, expected] :
       {std::pair(0.0f, 1.0f), {0.25f, 1.5f}, {1.0f, 3.0f}, {1.5f, 7.0f}, {2.0f, 11.0f}, {5.0f, 11.0f}, {-2.0f, 1.0f}})
    EXPECT_NEAR(texture.sample({0.3f, -0.2f, 1}, at).x, expected, 1e-5) << at;
}

TEST(CubeTexture, KeepsLightToATwoThousandth) {
  const auto kept = [](float value) {
    return CubeTexture({{faces_of(1, [=](int, int, int) { return glm::vec3(value); })}}).sample({1, 2, 3}, 0).x;
  };
  for (float value = 5e-10f; value < 4e9f; value *= 1.37f) EXPECT_NEAR(kept(value) / value, 1, 1.0 / 2000) << value;
  EXPECT_EQ(kept(1e-10f), 0);
  EXPECT_NEAR(kept(1e20f), 4.29e9, 1e7) << "the brightest";
}

TEST(CubeTexture, WhatIsNoLightIsBlack) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const CubeTexture texture({{faces_of(4, [&](int, int, int) { return glm::vec3(nan, inf, -3); })}});
  EXPECT_EQ(texture.sample({1, 2, 3}, 0), glm::vec3(0));
  EXPECT_EQ(CubeTexture(ReflectionMap{}).sample({1, 2, 3}, 0.7f), glm::vec3(0)) << "no levels";
  EXPECT_THROW(CubeTexture({{Image(4, 23)}}), Error);
  EXPECT_THROW(CubeTexture({{Image(4, 24, 4)}}), Error);
}

}  // namespace
}  // namespace catchlight::render
