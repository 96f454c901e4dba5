// Meshes of other files, and what is done to meshes.
#include "catchlight/color.hpp"
#include "catchlight/error.hpp"
#include "render/mesh/bounds.hpp"
#include "render/mesh_file/mesh_file.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/test_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

namespace catchlight::render {
namespace {

class MeshFile : public testing::Test {
 protected:
  Mesh load(const std::string& name) { return load_mesh(folder_ / name, warnings_.handler()); }

  TempFolder folder_;
  Warnings warnings_;
};

TEST_F(MeshFile, MissingOrUnknownFilesAreNamed) {
  write_text(folder_ / "a.fbx", "x");
  EXPECT_NE(error_of([&] { load("none.glb"); }).find("none.glb"), std::string::npos);
  EXPECT_NE(error_of([&] { load("a.fbx"); }).find(".obj"), std::string::npos);
}

TEST_F(MeshFile, ObjWithMaterials) {
  write_text(folder_ / "a.mtl", "newmtl red\nKd 0.8 0.1 0.1\nKs 0.5 0.5 0.5\nNs 98\nnewmtl matte\nKd 0.5 0.5 0.5\nKs 0 0 0\n");
  write_text(folder_ / "a.obj",
             "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl red\nf 1 2 3 4\nusemtl matte\nf 1 2 3\n");
  const Mesh mesh = load("a.obj");
  EXPECT_EQ(mesh.indices.size(), 9u);
  std::map<std::string, Material> by_name;
  for (const std::uint16_t material : mesh.triangle_material)
    by_name[mesh.materials.at(material).name] = mesh.materials[material];
  EXPECT_LT(glm::distance(by_name.at("red").base_color, glm::vec3(0.8f, 0.1f, 0.1f)), 1e-6f);
  EXPECT_NEAR(by_name.at("red").roughness, std::pow(0.02, 0.25), 1e-5);
  EXPECT_EQ(by_name.at("matte").dielectric_f0, 0);
  for (const Vertex& vertex : mesh.vertices) EXPECT_LT(glm::distance(vertex.normal, glm::vec3(0, 0, 1)), 1e-6f);
}

TEST_F(MeshFile, PlyWithColours) {
  write_text(folder_ / "a.ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
             "property uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
             "0 0 0 255 188 0\n1 0 0 255 188 0\n0 1 0 255 188 0\n3 0 1 2\n");
  const Mesh mesh = load("a.ply");
  ASSERT_EQ(mesh.vertices.size(), 3u);
  EXPECT_NEAR(mesh.vertices[0].color.y, linear_from_srgb(188 / 255.0), 1e-6);
}

TEST_F(MeshFile, EmptyObjAndPlyAreRefused) {
  write_text(folder_ / "a.obj", "v 0 0 0\n");
  write_text(folder_ / "a.ply", "ply\nformat ascii 1.0\nend_header\n");
  write_text(folder_ / "b.ply", "");
  for (const char* name : {"a.obj", "a.ply", "b.ply"}) EXPECT_NE(error_of([&] { load(name); }).find(name), std::string::npos);
}

TEST_F(MeshFile, SmoothSphereWithoutNormalsGetsRadialOnes) {
  // Area and angle weights: the cut of each quadrilateral into triangles must not tilt the normals.
  const Mesh exact = sphere({0, 0, 0}, 1, 24);
  std::string obj = "s 1\n";
  for (const Vertex& v : exact.vertices) {
    obj += "v " + std::to_string(v.position_m.x) + " " + std::to_string(v.position_m.y) + " " + std::to_string(v.position_m.z) +
           "\n";
  }
  for (std::size_t i = 0; i < exact.indices.size(); i += 3) {
    obj += "f";
    for (int k = 0; k < 3; ++k) obj += " " + std::to_string(exact.indices[i + k] + 1);
    obj += "\n";
  }
  write_text(folder_ / "sphere.obj", obj);
  for (const Vertex& vertex : load("sphere.obj").vertices) EXPECT_GT(glm::dot(vertex.normal, vertex.position_m), 0.9995f);
}

TEST_F(MeshFile, AMillionTrianglesLoad) {
  // Binary PLY: a grid of 708 x 708 quadrilaterals.
  constexpr int kSide = 709;
  std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(kSide * kSide) +
                    "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                    std::to_string(2 * (kSide - 1) * (kSide - 1)) + "\nproperty list uchar int vertex_indices\nend_header\n";
  const auto put = [&ply](const auto& value) { ply.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (int i = 0; i < kSide * kSide; ++i) {
    for (const float c : {static_cast<float>(i % kSide), static_cast<float>(i / kSide), 0.0f}) put(c);
  }
  for (int y = 0; y + 1 < kSide; ++y) {
    for (int x = 0; x + 1 < kSide; ++x) {
      const int a = y * kSide + x;
      for (const std::array<int, 3>& t :
           {std::array<int, 3>{a, a + 1, a + kSide}, std::array<int, 3>{a + 1, a + kSide + 1, a + kSide}}) {
        ply += '\3';
        for (const int index : t) put(index);
      }
    }
  }
  write_text(folder_ / "million.ply", ply);
  const Mesh mesh = load("million.ply");
  EXPECT_EQ(mesh.triangle_material.size(), 2u * (kSide - 1) * (kSide - 1));
  EXPECT_EQ(mesh.vertices[12345].normal, glm::vec3(0, 0, 1));
}

// ---- editing ----

double area_of(const Mesh& mesh) {
  double area = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto corner = [&](int k) { return glm::dvec3(mesh.vertices[mesh.indices[i + k]].position_m); };
    area += glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0))) / 2;
  }
  return area;
}

// Edges by the places of their ends that do not have exactly one neighbour running the other way.
int open_edges(const Mesh& mesh) {
  using Place = std::array<float, 3>;
  std::map<std::pair<Place, Place>, int> count;
  const auto place = [&](std::uint32_t v) {
    const glm::vec3& p = mesh.vertices[v].position_m;
    return Place{p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};
  };
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const Place from = place(mesh.indices[i]), to = place(mesh.indices[i % 3 == 2 ? i - 2 : i + 1]);
    ++count[{from, to}];
    --count[{to, from}];
  }
  int open = 0;
  for (const auto& [edge, times] : count) open += times > 0;
  return open;
}

TEST(Subdivision, SplitsHardEdgesAlikeAndLeavesNoCracks) {
  Mesh mesh = box({0, 0, 0}, {1, 0.7f, 0.31f});
  append(mesh, sphere({3, 0, 0}, 1, 6));
  ASSERT_EQ(open_edges(mesh), 0);
  const double area = area_of(mesh);
  subdivide_long_edges(mesh, 0.1, 100000);
  EXPECT_EQ(open_edges(mesh), 0);
  EXPECT_NEAR(area_of(mesh) / area, 1, 1e-6);
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const glm::vec3 a = mesh.vertices[mesh.indices[i]].position_m,
                    b = mesh.vertices[mesh.indices[i % 3 == 2 ? i - 2 : i + 1]].position_m;
    EXPECT_LE(glm::distance(a, b), 0.1f + 1e-6f);
  }
  for (const Vertex& vertex : mesh.vertices) EXPECT_NEAR(glm::length(vertex.normal), 1, 1e-6);
  EXPECT_EQ(mesh.triangle_material.size() * 3, mesh.indices.size());
}

TEST(Subdivision, KeepsWindingMaterialAndInterpolatesColour) {
  Mesh mesh;
  add_quad(mesh, {0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {0, 1, 0});
  mesh.materials.push_back(white());
  mesh.triangle_material = {0, 1};
  for (Vertex& vertex : mesh.vertices) vertex.color = glm::vec3(vertex.position_m.x / 4);
  subdivide_long_edges(mesh, 0.5, 10000);
  double area[2] = {0, 0};
  for (std::size_t t = 0; t < mesh.triangle_material.size(); ++t) {
    const auto corner = [&](int k) { return mesh.vertices[mesh.indices[3 * t + k]].position_m; };
    const float z = glm::cross(corner(1) - corner(0), corner(2) - corner(0)).z;
    EXPECT_GT(z, 0);
    area[mesh.triangle_material[t]] += z / 2;
  }
  EXPECT_NEAR(area[0], 2, 1e-5);
  EXPECT_NEAR(area[1], 2, 1e-5);
  for (const Vertex& vertex : mesh.vertices) EXPECT_NEAR(vertex.color.x, vertex.position_m.x / 4, 1e-6);
}

TEST(Subdivision, StopsBeforeTheLimit) {
  Mesh mesh = box({0, 0, 0}, {1, 1, 1});
  subdivide_long_edges(mesh, 1e-4, 5000);
  EXPECT_LE(mesh.vertices.size(), 5000u);
  EXPECT_GT(mesh.vertices.size(), 1000u);
}

TEST(Subdivision, LeavesShortEdgesAlone) {
  Mesh mesh = box({0, 0, 0}, {1, 1, 1});
  subdivide_long_edges(mesh, 2, 5000);
  EXPECT_EQ(mesh.vertices.size(), 24u);
  EXPECT_THROW(subdivide_long_edges(mesh, 0, 5000), Error);
}

TEST(Transformed, MovesPointsAndKeepsNormalsPerpendicularAndOutward) {
  const Mesh mesh = box({0, 0, 0}, {1, 1, 1});
  const glm::dmat4 shear(glm::dvec4(2, 0, 0, 0), glm::dvec4(1, 1, 0, 0), glm::dvec4(0, 0, -3, 0), glm::dvec4(5, 6, 7, 1));
  const Mesh moved = transformed(mesh, shear);
  for (std::size_t i = 0; i < moved.indices.size(); i += 3) {
    const auto corner = [&](int k) { return moved.vertices[moved.indices[i + k]]; };
    const glm::vec3 face =
        glm::normalize(glm::cross(corner(1).position_m - corner(0).position_m, corner(2).position_m - corner(0).position_m));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(glm::dot(face, corner(k).normal), 1, 1e-5);
  }
  EXPECT_THROW(transformed(mesh, glm::dmat4(0)), Error);
  EXPECT_THROW(transformed(mesh, glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 1, 0, 0), glm::dvec4(1, 1, 0, 0),
                                            glm::dvec4(0, 0, 0, 1))),
               Error);
}

TEST(UpperHalf, OfABallIsADome) {
  // An octahedron whose belt goes up and down.
  Mesh ball;
  ball.materials.emplace_back();
  const glm::vec3 corners[] = {{1, 0, 0.1f}, {0, 1, -0.1f}, {-1, 0, 0.1f}, {0, -1, -0.1f}, {0, 0, 1}, {0, 0, -1}};
  for (const glm::vec3& corner : corners) ball.vertices.push_back({corner, glm::normalize(corner)});
  ball.indices = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 1, 0, 5, 2, 1, 5, 3, 2, 5, 0, 3, 5};
  ball.triangle_material.assign(8, 0);
  const Mesh dome = upper_half(ball);
  double flux = 0;  // what flows out through a closed surface is nothing, so this is what the missing bottom takes
  for (std::size_t i = 0; i < dome.indices.size(); i += 3) {
    const auto corner = [&](int k) { return glm::dvec3(dome.vertices[dome.indices[i + k]].position_m); };
    flux += glm::cross(corner(1) - corner(0), corner(2) - corner(0)).z / 2;
  }
  std::size_t rim = 0;
  for (const Vertex& vertex : dome.vertices) rim += vertex.position_m.z == 0;
  EXPECT_EQ(rim, 8u) << "four edges of the belt, and four below two of its corners, each crossed once";
  EXPECT_NEAR(flux, 20.0 / 11, 1e-6) << "the rim is an octagon with corners at 10/11 and (1/2, 1/2)";
  for (const std::uint16_t material : dome.triangle_material) EXPECT_EQ(material, 0);
}

TEST(Bounds, HoldTheTrianglesAndNothingElse) {
  Mesh mesh = box({-1, 2, 0.5f}, {3, 4, 6});
  mesh.vertices.push_back({{100, 100, 100}, {0, 0, 1}});  // no triangle's
  const Bounds bounds = bounds_of(mesh);
  EXPECT_EQ(bounds.min_m, glm::vec3(-1, 2, 0.5f));
  EXPECT_EQ(bounds.max_m, glm::vec3(3, 4, 6));
  EXPECT_EQ(bounds.middle_m(), glm::vec3(1, 3, 3.25f));
  EXPECT_FLOAT_EQ(bounds.diagonal_m(), std::sqrt(16 + 4 + 30.25f));
  EXPECT_FALSE(bounds.empty());
  EXPECT_TRUE(bounds_of(Mesh{}).empty());
}

TEST(Append, KeepsMaterialsApart) {
  Mesh mesh = box({0, 0, 0}, {1, 1, 1}), other = sphere({0, 0, 0}, 1, 4);
  other.materials[0].name = "second";
  append(mesh, other);
  EXPECT_EQ(mesh.materials.size(), 2u);
  EXPECT_EQ(mesh.materials[mesh.triangle_material.back()].name, "second");
  EXPECT_LT(*std::max_element(mesh.indices.begin(), mesh.indices.end()), mesh.vertices.size());
}

}  // namespace
}  // namespace catchlight::render
