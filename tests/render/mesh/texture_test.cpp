#include "render/mesh/texture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "catchlight/color.hpp"
#include "render/mesh/mesh.hpp"

namespace catchlight::render {
namespace {

constexpr std::array<TextureWrap, 2> kRepeat{TextureWrap::repeat, TextureWrap::repeat};

/// Columns of black and white.
Texture stripes(int width, int height, bool is_srgb = false, std::array<TextureWrap, 2> wrap = kRepeat) {
  TextureLevel level{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 4; ++c) level.rgba.push_back(c == 3 || x % 2 == 1 ? 255 : 0);
  return make_texture("stripes", level, is_srgb, wrap);
}

TextureFootprint footprint(float x, float y) {
  return {{x, 0}, {0, y}};
}

TEST(Texture, MipmapsHalveDownToOnePixel) {
  const Texture texture = stripes(12, 5);
  ASSERT_EQ(texture.levels.size(), 4u);
  EXPECT_EQ(texture.levels[1].width, 6);
  EXPECT_EQ(texture.levels[1].height, 2);
  EXPECT_EQ(texture.levels[3].width * texture.levels[3].height, 1);
}

TEST(Texture, MeansAreThoseOfLightNotOfCodes) {
  const glm::vec4 data = look_up(stripes(64, 64), {0.3f, 0.3f}, footprint(0.5f, 0.5f));
  const glm::vec4 color = look_up(stripes(64, 64, true), {0.3f, 0.3f}, footprint(0.5f, 0.5f));
  EXPECT_NEAR(data.g, 0.5, 0.01);
  EXPECT_NEAR(color.g, 0.5, 0.01) << "half of the area is white";
  EXPECT_EQ(color.a, 1);
}

TEST(Texture, MiddlesOfTexelsAreTheTexels) {
  const Texture texture = stripes(8, 8);
  for (int x = 0; x < 8; ++x)
    EXPECT_EQ(look_up(texture, {(static_cast<float>(x) + 0.5f) / 8, 0.4f}, footprint(1e-4f, 1e-4f)).r, x % 2 == 1 ? 1 : 0);
}

TEST(Texture, BetweenTexelsItIsLinear) {
  EXPECT_NEAR(look_up(stripes(8, 8), {1.75f / 8, 0.5f}, footprint(1e-4f, 1e-4f)).r, 0.75, 1e-5);
}

TEST(Texture, WrapsAsItIsTold) {
  for (const auto& [wrap, expected] : {std::pair{TextureWrap::repeat, 0.0f}, std::pair{TextureWrap::clamp, 1.0f}})
    EXPECT_EQ(look_up(stripes(8, 8, false, {wrap, wrap}), {8.5f / 8, 0.5f}, {}).r, expected);
  const Texture mirrored = stripes(8, 8, false, {TextureWrap::mirror, TextureWrap::mirror});
  EXPECT_EQ(look_up(mirrored, {8.5f / 8, 0.5f}, {}).r, look_up(mirrored, {7.5f / 8, 0.5f}, {}).r);
  EXPECT_EQ(look_up(mirrored, {-0.5f / 8, 0.5f}, {}).r, look_up(mirrored, {0.5f / 8, 0.5f}, {}).r);
}

/// Stripes seen at a slant: sharp across the footprint's shorter axis, where isotropic mipmaps would be grey.
TEST(Texture, AnAnisotropicFootprintStaysSharpAcross) {
  const Texture texture = stripes(64, 64);
  EXPECT_GT(look_up(texture, {1.5f / 64, 0.5f}, footprint(0.5f / 64, 8.0f / 64)).r, 0.9);
  EXPECT_NEAR(look_up(texture, {1.5f / 64, 0.5f}, footprint(8.0f / 64, 0.5f / 64)).r, 0.5, 0.05);
}

/// Against the mean of many unfiltered look-ups over the footprint's parallelogram.
TEST(Texture, IsTheMeanOverItsFootprint) {
  TextureLevel noise{64, 64, {}};
  std::uint32_t state = 1;
  for (int i = 0; i < 64 * 64 * 4; ++i)
    noise.rgba.push_back(static_cast<std::uint8_t>((state = state * 1664525 + 1013904223) >> 24));
  const Texture texture = make_texture("noise", noise, false, kRepeat);
  double squares = 0;
  constexpr int kPlaces = 50;
  for (int i = 0; i < kPlaces; ++i) {
    const glm::vec2 uv(0.017f * static_cast<float>(i), 0.31f + 0.023f * static_cast<float>(i));
    const TextureFootprint area{{6.0f / 64, 2.0f / 64}, {-1.0f / 64, 3.0f / 64}};
    double mean = 0;
    for (int a = 0; a < 32; ++a)
      for (int b = 0; b < 32; ++b)
        mean +=
            look_up(texture,
                    uv + (static_cast<float>(a) / 32 - 0.5f) * area.along_x + (static_cast<float>(b) / 32 - 0.5f) * area.along_y,
                    {})
                .r /
            1024;
    squares += std::pow(look_up(texture, uv, area).r - mean, 2);
  }
  EXPECT_LT(std::sqrt(squares / kPlaces), 0.05) << "white noise has a deviation of 0.29";
}

TEST(Texture, CoordinatesThatAreNotFiniteGiveTheMean) {
  const Texture texture = stripes(8, 8);
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    EXPECT_NEAR(look_up(texture, {bad, 0}, {}).r, 0.5, 0.01);
    EXPECT_NEAR(look_up(texture, {0, 0}, {{bad, 0}, {0, bad}}).r, 0.5, 0.01);
  }
  EXPECT_TRUE(std::isfinite(look_up(texture, {1e30f, -1e30f}, footprint(1, 1)).r));
}

/// A square of 2 m with texture coordinates from 0 to 1 and tangents along +x.
Mesh square(float bottom_m) {
  Mesh mesh;
  for (const glm::vec2& uv : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
    mesh.vertices.push_back({{2 * uv.x - 1, 0, bottom_m + 2 * uv.y}, {0, -1, 0}});
    mesh.texture_coordinates.push_back({{uv, 2.0f * uv}, {1, 0, 0, 1}});
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  mesh.triangle_material = {0, 0};
  mesh.materials.emplace_back().base_color_texture.texture = 0;
  mesh.textures.push_back(std::make_shared<Texture>(stripes(8, 8)));
  return mesh;
}

/// Every vertex still has the coordinates of its place on the square.
void expect_in_place(const Mesh& mesh, float bottom_m) {
  ASSERT_EQ(mesh.texture_coordinates.size(), mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const glm::vec2 uv((mesh.vertices[v].position_m.x + 1) / 2, (mesh.vertices[v].position_m.z - bottom_m) / 2);
    EXPECT_LT(glm::distance(mesh.texture_coordinates[v].uv[0], uv), 1e-6f);
    EXPECT_LT(glm::distance(mesh.texture_coordinates[v].uv[1], 2.0f * uv), 1e-6f);
    EXPECT_EQ(mesh.texture_coordinates[v].tangent, glm::vec4(1, 0, 0, 1));
  }
}

TEST(TextureCoordinates, StayWithTheSurfaceThatIsCutAndDivided) {
  Mesh divided = square(0);
  subdivide_long_edges(divided, 0.3, 10'000);
  EXPECT_GT(divided.vertices.size(), 40u);
  expect_in_place(divided, 0);
  const Mesh cut = upper_half(square(-0.7f));
  EXPECT_LT(cut.vertices.size(), 7u);
  expect_in_place(cut, -0.7f);
}

TEST(TextureCoordinates, TangentsTurnWithTheObjectAndMirrorWithIt) {
  const Mesh turned = transformed(square(0), glm::dmat4(0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1));
  EXPECT_EQ(turned.texture_coordinates[0].tangent, glm::vec4(0, 1, 0, 1));
  const Mesh mirrored = transformed(square(0), glm::dmat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1));
  EXPECT_EQ(mirrored.texture_coordinates[0].tangent, glm::vec4(-1, 0, 0, -1));
}

TEST(TextureCoordinates, AppendedMeshesKeepTheirOwnTextures) {
  Mesh plain = square(0);
  plain.texture_coordinates.clear(), plain.textures.clear(), plain.materials[0] = {};
  Mesh mesh = plain;
  append(mesh, square(0));
  append(mesh, square(0));
  append(mesh, plain);
  EXPECT_EQ(mesh.texture_coordinates.size(), mesh.vertices.size());
  EXPECT_EQ(mesh.textures.size(), 2u);
  EXPECT_FALSE(mesh.materials[0].has_textures());
  EXPECT_EQ(mesh.materials[1].base_color_texture.texture, 0);
  EXPECT_EQ(mesh.materials[2].base_color_texture.texture, 1);
  EXPECT_EQ(mesh.texture_coordinates[6].uv[0], glm::vec2(1, 1));
}

}  // namespace
}  // namespace catchlight::render
