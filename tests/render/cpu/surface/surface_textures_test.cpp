#include "render/cpu/surface/surface_textures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

namespace catchlight::render {
namespace {

std::shared_ptr<const Texture> texture_of(int width, int height, const std::function<glm::vec4(float, float)>& value) {
  TextureLevel level{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::vec4 v = value((static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                                (static_cast<float>(y) + 0.5f) / static_cast<float>(height));
      for (int c = 0; c < 4; ++c) level.rgba.push_back(static_cast<std::uint8_t>(std::lround(255 * v[c])));
    }
  return std::make_shared<Texture>(make_texture("test", level, false, {TextureWrap::clamp, TextureWrap::clamp}));
}

/// A square of 0.2 m in the plane z = 0 around the origin, u along +x and v along +y, under a camera 0.5 m above it.
struct Square {
  Mesh mesh;
  FrameView view;

  explicit Square(const std::shared_ptr<const Texture>& texture) {
    for (const glm::vec2& uv : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
      mesh.vertices.push_back({{0.2f * uv - 0.1f, 0}, {0, 0, 1}});
      mesh.texture_coordinates.push_back({{uv, uv}, {1, 0, 0, 1}});
    }
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.triangle_material = {0, 0};
    mesh.materials.emplace_back();
    mesh.textures = {texture};
    view.camera = {.width_px = 100, .height_px = 100, .fx_px = 100, .fy_px = 100, .cx_px = 49.5, .cy_px = 49.5};
    view.camera_from_tag.rotation = glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1);
    view.camera_from_tag.translation_m = {0, 0, 0.5};
  }

  /// The point in the first triangle at these texture coordinates.
  SurfacePoint point_at(float u, float v, bool is_back = false) const {
    SurfacePoint point;
    point.position_m = {0.2f * u - 0.1f, 0.2f * v - 0.1f, 0};
    point.weights = {u - v, v};
    point.normal = {0, 0, is_back ? -1 : 1};
    point.to_viewer = glm::normalize(glm::vec3(0, 0, is_back ? -0.5f : 0.5f) - point.position_m);
    point.depth_m = 0.5f;
    point.is_back = is_back;
    return point;
  }

  std::pair<SurfacePoint, TexturedSurface> look(const SurfacePoint& point) const {
    const SurfaceMaterials materials = surface_materials(mesh);
    VisibleSurface surface;
    surface.points = {point};
    SurfaceTextures(mesh, materials).apply(view, surface);
    return {surface.points[0], surface.textured.at(0)};
  }
};

TEST(SurfaceTextures, MultiplyTheFactors) {
  Square square(texture_of(64, 64, [](float u, float v) { return glm::vec4(u, v, 0.5f, 1); }));
  Material& material = square.mesh.materials[0];
  material.base_color = {0.5f, 1, 1}, material.metallic = 0.8f, material.roughness = 0.6f, material.emissive = glm::vec3(10);
  for (MaterialTexture* use : {&material.base_color_texture, &material.metallic_roughness_texture, &material.emissive_texture})
    use->texture = 0;
  const TexturedSurface textured = square.look(square.point_at(0.75f, 0.25f)).second;
  EXPECT_NEAR(textured.material.base_color_metallic.r, 0.5 * 0.75, 0.01);
  EXPECT_NEAR(textured.material.base_color_metallic.g, 0.25, 0.01);
  EXPECT_NEAR(textured.material.base_color_metallic.a, 0.8 * 0.5, 0.01) << "metallic is blue";
  EXPECT_NEAR(textured.material.emissive_roughness.a, 0.6 * 0.25, 0.01) << "roughness is green";
  EXPECT_NEAR(textured.material.emissive_roughness.r, 7.5, 0.1);
  EXPECT_FALSE(textured.is_bent);
}

TEST(SurfaceTextures, PixelsShowTheMeanOfWhatTheyCover) {
  // A pixel is 5 mm wide on the square, and the texture's columns are 3 mm: a pixel shows neither black nor white.
  Square square(texture_of(64, 1, [](float u, float) { return glm::vec4(static_cast<int>(u * 64) % 2); }));
  square.mesh.materials[0].base_color_texture.texture = 0;
  EXPECT_NEAR(square.look(square.point_at(0.6f, 0.3f)).second.material.base_color_metallic.r, 0.8 * 0.5, 0.1);
  square.view.camera.fx_px = square.view.camera.fy_px = 10'000;
  EXPECT_NEAR(square.look(square.point_at(38.5f / 64, 0.3f)).second.material.base_color_metallic.r, 0, 0.05)
      << "close up, a column";
}

TEST(SurfaceTextures, TransformedCoordinatesLookElsewhere) {
  Square square(texture_of(64, 64, [](float u, float v) { return glm::vec4(u, v, 0, 1); }));
  MaterialTexture& use = square.mesh.materials[0].base_color_texture;
  use.texture = 0;
  use.uv_transform = glm::mat3(0, 0.5f, 0, -0.5f, 0, 0, 0.5f, 0.25f, 1);  // a quarter turn, half as large, moved
  const auto material = square.look(square.point_at(0.6f, 0.2f)).second.material;
  EXPECT_NEAR(material.base_color_metallic.r / 0.8f, 0.5 - 0.5 * 0.2, 0.01);
  EXPECT_NEAR(material.base_color_metallic.g / 0.8f, 0.25 + 0.5 * 0.6, 0.01);
}

TEST(SurfaceTextures, ANormalMapTurnsTheNormalByItsSlopes) {
  Square square(texture_of(4, 4, [](float, float) { return glm::vec4(0.5f + 0.5f * 0.6f, 0.5f, 0.5f + 0.5f * 0.8f, 1); }));
  MaterialTexture& use = square.mesh.materials[0].normal_texture;
  use.texture = 0;
  const auto [point, textured] = square.look(square.point_at(0.5f, 0.4f));
  EXPECT_TRUE(textured.is_bent);
  EXPECT_EQ(textured.smooth_normal, glm::vec3(0, 0, 1));
  EXPECT_LT(glm::distance(point.normal, glm::vec3(0.6f, 0, 0.8f)), 0.01f) << "towards the tangent";
  use.strength = 0;
  EXPECT_LT(glm::distance(square.look(square.point_at(0.5f, 0.4f)).first.normal, glm::vec3(0, 0, 1)), 0.01f);
}

TEST(SurfaceTextures, GreenIsUpAndAMirroredIslandTurnsItRound) {
  Square square(texture_of(4, 4, [](float, float) { return glm::vec4(0.5f, 0.8f, 0.9f, 1); }));
  square.mesh.materials[0].normal_texture.texture = 0;
  EXPECT_GT(square.look(square.point_at(0.5f, 0.4f)).first.normal.y, 0.5f) << "along v, as the bitangent runs";
  for (TextureCoordinates& place : square.mesh.texture_coordinates) place.tangent.w = -1;
  EXPECT_LT(square.look(square.point_at(0.5f, 0.4f)).first.normal.y, -0.5f);
}

TEST(SurfaceTextures, TheBackIsTheFrontTurnedRound) {
  Square square(texture_of(4, 4, [](float, float) { return glm::vec4(0.5f + 0.5f * 0.6f, 0.5f, 0.5f + 0.5f * 0.8f, 1); }));
  square.mesh.materials[0].normal_texture.texture = 0;
  const glm::vec3 back = square.look(square.point_at(0.5f, 0.4f, true)).first.normal;
  EXPECT_LT(glm::distance(back, -glm::vec3(0.6f, 0, 0.8f)), 0.01f);
}

TEST(SurfaceTextures, WhatIsSeenLooksTowardsTheViewer) {
  Square square(texture_of(4, 4, [](float, float) { return glm::vec4(1, 0.5f, 0.51f, 1); }));
  square.mesh.materials[0].normal_texture.texture = 0;
  SurfacePoint point = square.point_at(0.5f, 0.4f);
  point.to_viewer = glm::normalize(glm::vec3(-1, 0, 0.1f));
  const SurfacePoint bent = square.look(point).first;
  EXPECT_GT(glm::dot(bent.normal, bent.to_viewer), 0);
  EXPECT_NEAR(glm::length(bent.normal), 1, 1e-5);
}

TEST(SurfaceTextures, WithoutTangentsTheNormalStays) {
  Square square(texture_of(4, 4, [](float, float) { return glm::vec4(1, 0.5f, 0.5f, 1); }));
  square.mesh.materials[0].normal_texture.texture = 0;
  for (TextureCoordinates& place : square.mesh.texture_coordinates) place.tangent = glm::vec4(0);
  EXPECT_EQ(square.look(square.point_at(0.5f, 0.4f)).first.normal, glm::vec3(0, 0, 1));
}

TEST(SurfaceTextures, OcclusionIsAsStrongAsTheMaterialSays) {
  Square square(texture_of(4, 4, [](float, float) { return glm::vec4(0.2f, 0, 0, 1); }));
  square.mesh.materials[0].occlusion_texture.texture = 0;
  EXPECT_NEAR(square.look(square.point_at(0.5f, 0.4f)).second.occlusion, 0.2, 0.01);
  square.mesh.materials[0].occlusion_texture.strength = 0.5f;
  EXPECT_NEAR(square.look(square.point_at(0.5f, 0.4f)).second.occlusion, 0.6, 0.01);
}

TEST(SurfaceTextures, LeaveUntexturedPointsAlone) {
  Square square(texture_of(4, 4, [](float, float) { return glm::vec4(0.5f); }));
  const SurfaceMaterials materials = surface_materials(square.mesh);
  VisibleSurface surface;
  surface.points = {square.point_at(0.5f, 0.4f)};
  SurfaceTextures(square.mesh, materials).apply(square.view, surface);
  EXPECT_TRUE(surface.textured.empty());
  EXPECT_EQ(surface.textured_at(surface.points[0]), nullptr);
}

}  // namespace
}  // namespace catchlight::render
