// What the transfer makes of materials.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/transfer/transfer.hpp"
#include "tests/support/shapes.hpp"

namespace catchlight::render {
namespace {

const ReceiverGrid kNoReceiver{};

TransferOptions with(int bands, int rays, int bounces = 0) {
  TransferOptions options;
  options.bands = bands, options.rays = rays, options.bounces = bounces;
  return options;
}

TEST(TransferOfMaterials, MetalHasNoDiffuseLight) {
  Mesh mesh = sphere({0, 0, 0}, 1, 8);
  mesh.materials[0].metallic = 1;
  for (const glm::vec3& value : bake_transfer(mesh, kNoReceiver, with(3, 64, 1), {}).object) EXPECT_EQ(value, glm::vec3(0));
}

TEST(TransferOfMaterials, VertexColoursScaleTheAlbedo) {
  Mesh tinted = sphere({0, 0, 0}, 1, 8, true), plain = tinted;
  for (Mesh* mesh : {&tinted, &plain}) {
    mesh->indices.resize(mesh->indices.size() / 2);
    mesh->triangle_material.resize(mesh->indices.size() / 3);
  }
  tinted.materials[0].base_color = {1, 0.5f, 1};
  for (Vertex& vertex : tinted.vertices) vertex.color = {0.25f, 0.5f, 1};
  plain.materials[0].base_color = {0.25f, 0.25f, 1};
  const TransferOptions options = with(1, 64, 2);
  EXPECT_EQ(bake_transfer(tinted, kNoReceiver, options, {}).object, bake_transfer(plain, kNoReceiver, options, {}).object);
}

TEST(TransferOfMaterials, ABlackVertexOfATextureIsLit) {
  Mesh mesh = sphere({0, 0, 0}, 1, 8);
  for (Vertex& vertex : mesh.vertices) vertex.color = glm::vec3(0);
  EXPECT_EQ(bake_transfer(mesh, kNoReceiver, with(1, 16), {}).object[5], glm::vec3(0)) << "nothing of it is diffuse";
  mesh.materials[0].base_color_texture.texture = 0;
  EXPECT_NEAR(bake_transfer(mesh, kNoReceiver, with(1, 16), {}).object[5].x * 2 * std::sqrt(std::numbers::pi), 1, 1e-6);
}

}  // namespace
}  // namespace catchlight::render
