#include "render/mesh_file/tangents.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace catchlight::render {
namespace {

/// Normal-mapped vertices; triangles are added by hand.
Mesh mapped() {
  Mesh mesh;
  mesh.materials.emplace_back().normal_texture.texture = 0;
  mesh.textures.push_back(std::make_shared<Texture>(make_texture("flat", {1, 1, {128, 128, 255, 255}}, false, {})));
  return mesh;
}

void add_vertex(Mesh& mesh, const glm::vec3& position_m, const glm::vec3& normal, const glm::vec2& uv) {
  mesh.vertices.push_back({position_m, normal});
  mesh.texture_coordinates.push_back({{uv, glm::vec2(0)}, glm::vec4(0)});
}

void add_triangles(Mesh& mesh, const std::vector<std::uint32_t>& corners) {
  mesh.indices.insert(mesh.indices.end(), corners.begin(), corners.end());
  mesh.triangle_material.resize(mesh.indices.size() / 3);
}

/// A picture upright on a plane: u runs along +x, v down.
Mesh plane() {
  Mesh mesh = mapped();
  for (const glm::vec2& p : {glm::vec2(0, 0), glm::vec2(2, 0), glm::vec2(2, 1), glm::vec2(0, 1)})
    add_vertex(mesh, {p, 0}, {0, 0, 1}, {p.x / 2, 1 - p.y});
  add_triangles(mesh, {0, 1, 2, 0, 2, 3});
  return mesh;
}

TEST(Tangents, RunAlongUOnAPlane) {
  Mesh mesh = plane();
  make_missing_tangents(mesh);
  ASSERT_EQ(mesh.vertices.size(), 4u);
  for (const TextureCoordinates& place : mesh.texture_coordinates)
    EXPECT_LT(glm::distance(place.tangent, glm::vec4(1, 0, 0, 1)), 1e-6f) << "+y of the map is up, as is cross(normal, tangent)";
}

TEST(Tangents, FollowTheTexturesTransform) {
  Mesh mesh = plane();
  mesh.materials[0].normal_texture.uv_transform = glm::mat3(0, 1, 0, -1, 0, 0, 0, 0, 1);  // u' = -v
  make_missing_tangents(mesh);
  EXPECT_LT(glm::distance(mesh.texture_coordinates[0].tangent, glm::vec4(0, 1, 0, 1)), 1e-6f);
}

TEST(Tangents, GoRoundACylinder) {
  Mesh mesh = mapped();
  constexpr int kSides = 16;
  for (int i = 0; i <= kSides; ++i)
    for (const float z : {0.0f, 1.0f}) {
      const double angle = 2 * std::numbers::pi * (i % kSides) / kSides;
      const glm::vec3 out(std::cos(angle), std::sin(angle), 0);
      add_vertex(mesh, out + glm::vec3(0, 0, z), out, {static_cast<float>(i) / kSides, 1 - z});
    }
  for (std::uint32_t i = 0; i < kSides; ++i) add_triangles(mesh, {2 * i, 2 * i + 2, 2 * i + 1, 2 * i + 1, 2 * i + 2, 2 * i + 3});
  make_missing_tangents(mesh);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const glm::vec3 out = mesh.vertices[v].normal;
    EXPECT_LT(glm::distance(mesh.texture_coordinates[v].tangent, glm::vec4(-out.y, out.x, 0, 1)), 1e-5f) << v;
  }
}

/// The right half shows the left half's picture, mirrored: u runs away from the seam on both sides.
TEST(Tangents, OfAMirroredIslandAreNotJoinedAcrossTheSeam) {
  Mesh mesh = mapped();
  for (const glm::vec2& p :
       {glm::vec2(-1, 0), glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(-1, 1), glm::vec2(0, 1), glm::vec2(1, 1)})
    add_vertex(mesh, {p, 0}, {0, 0, 1}, {std::abs(p.x), 1 - p.y});
  add_triangles(mesh, {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4});
  make_missing_tangents(mesh);
  EXPECT_EQ(mesh.vertices.size(), 8u) << "the two on the seam are four";
  for (std::size_t corner = 0; corner < mesh.indices.size(); ++corner) {
    const bool is_left = corner < 6;
    const glm::vec4 expected = is_left ? glm::vec4(-1, 0, 0, -1) : glm::vec4(1, 0, 0, 1);
    EXPECT_LT(glm::distance(mesh.texture_coordinates[mesh.indices[corner]].tangent, expected), 1e-6f) << corner;
  }
}

TEST(Tangents, OfVerticesThatTheFileDoublesAreTheSame) {
  Mesh mesh = mapped();  // a roof with one normal along its ridge, whose vertices each side has for itself
  const glm::vec3 up(0, 0, 1);
  for (const float side : {-1.0f, 1.0f})
    for (const glm::vec2& p : {glm::vec2(0, 0), glm::vec2(0, 1), glm::vec2(side, 0)})
      add_vertex(mesh, {p, -std::abs(p.x)}, up, {p.x + 0.3f * p.y, 1 - p.y});
  add_triangles(mesh, {0, 1, 2, 3, 5, 4});
  make_missing_tangents(mesh);
  EXPECT_EQ(mesh.texture_coordinates[0].tangent, mesh.texture_coordinates[3].tangent);
  EXPECT_EQ(mesh.texture_coordinates[1].tangent, mesh.texture_coordinates[4].tangent);
}

TEST(Tangents, OfTheFileAreKept) {
  Mesh mesh = plane();
  mesh.texture_coordinates[2].tangent = glm::vec4(0, 1, 0, -1);
  make_missing_tangents(mesh);
  EXPECT_EQ(mesh.texture_coordinates[2].tangent, glm::vec4(0, 1, 0, -1));
  EXPECT_LT(glm::distance(mesh.texture_coordinates[0].tangent, glm::vec4(1, 0, 0, 1)), 1e-6f);
}

TEST(Tangents, WithoutAnAreaInTheTextureLieInTheSurface) {
  Mesh mesh = plane();
  for (TextureCoordinates& place : mesh.texture_coordinates) place.uv[0] = {0.5f, 0.5f};
  make_missing_tangents(mesh);
  for (const TextureCoordinates& place : mesh.texture_coordinates) {
    EXPECT_NEAR(glm::length(glm::vec3(place.tangent)), 1, 1e-6);
    EXPECT_EQ(place.tangent.z, 0);
    EXPECT_EQ(place.tangent.w, 1);
  }
}

}  // namespace
}  // namespace catchlight::render
