#include "render/mesh/base_color.hpp"

#include <gtest/gtest.h>

namespace catchlight::render {
namespace {

/// A square of n x n cells, seen whole in a texture of 64 x 64 in which every second column is black.
Mesh striped_square(int cells) {
  Mesh mesh;
  TextureLevel picture{64, 64, {}};
  for (int i = 0; i < 64 * 64; ++i) picture.rgba.insert(picture.rgba.end(), 4, i % 2 == 1 ? 255 : 0);
  mesh.textures.push_back(std::make_shared<Texture>(make_texture("stripes", picture, false, {})));
  mesh.materials.emplace_back().base_color = glm::vec3(0.5f, 1, 1);
  mesh.materials[0].base_color_texture.texture = 0;
  for (int y = 0; y <= cells; ++y)
    for (int x = 0; x <= cells; ++x) {
      const glm::vec2 uv(static_cast<float>(x) / static_cast<float>(cells), static_cast<float>(y) / static_cast<float>(cells));
      mesh.vertices.push_back({{uv.x, uv.y, 0}, {0, 0, 1}, {1, 0.5f, 1}});
      mesh.texture_coordinates.push_back({{uv, uv}, {}});
    }
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      const auto a = static_cast<std::uint32_t>(y * (cells + 1) + x), b = a + static_cast<std::uint32_t>(cells) + 1;
      mesh.indices.insert(mesh.indices.end(), {a, a + 1, b, a + 1, b + 1, b});
      mesh.triangle_material.insert(mesh.triangle_material.end(), 2, 0);
    }
  return mesh;
}

TEST(BaseColor, OfAVertexIsTheTexturesMeanAroundIt) {
  for (const glm::vec3& color : vertex_base_colors(striped_square(4)))
    EXPECT_LT(glm::distance(color, glm::vec3(0.25f, 0.25f, 0.5f)), 0.02f) << "half is black";
}

TEST(BaseColor, WithoutTexturesIsThatOfMaterialAndVertex) {
  Mesh mesh = striped_square(2);
  mesh.textures.clear(), mesh.texture_coordinates.clear(), mesh.materials[0].base_color_texture = {};
  for (const glm::vec3& color : vertex_base_colors(mesh)) EXPECT_EQ(color, glm::vec3(0.5f, 0.5f, 1));
}

TEST(BaseColor, AlbedoIsWhatMetalLeavesOfIt) {
  Mesh mesh = striped_square(4);
  mesh.materials[0].metallic = 0.5f;
  for (const glm::vec3& albedo : vertex_diffuse_albedos(mesh))
    EXPECT_LT(glm::distance(albedo, 0.5f * glm::vec3(0.25f, 0.25f, 0.5f)), 0.01f);
  mesh.materials[0].metallic_roughness_texture.texture = 0;
  for (TextureCoordinates& place : mesh.texture_coordinates) place.uv[1] = glm::vec2(0.5f / 64);
  mesh.materials[0].metallic_roughness_texture.set = 1;
  for (const glm::vec3& albedo : vertex_diffuse_albedos(mesh))
    EXPECT_LT(glm::distance(albedo, glm::vec3(0.25f, 0.25f, 0.5f)), 0.02f) << "the texture says that it is no metal";
}

TEST(BaseColor, FoldedTexturesAreTheTexelsAtTheVertices) {
  Mesh mesh = striped_square(1);
  mesh.texture_coordinates[0].uv[0] = {1.5f / 64, 0.5f};
  mesh.texture_coordinates[1].uv[0] = {2.5f / 64, 0.5f};
  fold_base_color_textures(mesh);
  EXPECT_EQ(mesh.vertices[0].color, glm::vec3(1, 0.5f, 1));
  EXPECT_EQ(mesh.vertices[1].color, glm::vec3(0));
  EXPECT_FALSE(mesh.has_textures());
  EXPECT_FALSE(mesh.materials[0].has_textures());
}

}  // namespace
}  // namespace catchlight::render
