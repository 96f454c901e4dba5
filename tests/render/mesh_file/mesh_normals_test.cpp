// What becomes of meshes without normals: flat, or smooth where their file says so.
#include "render/mesh_file/mesh_file.hpp"
#include "render/mesh_file/mesh_import.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/test_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace catchlight::render {
namespace {

glm::dvec3 face_normal(const Mesh& mesh, std::size_t triangle) {
  const auto corner = [&](int k) { return glm::dvec3(mesh.vertices[mesh.indices[3 * triangle + k]].position_m); };
  return glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
}

// The greatest distance between a corner's normal and its face's.
double departure_from_flat(const Mesh& mesh) {
  double most = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); ++i)
    most = std::max(most, glm::distance(glm::dvec3(mesh.vertices[mesh.indices[i]].normal), face_normal(mesh, i / 3)));
  return most;
}

const std::string kCubeCorners = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n";
const char* const kCubeFaces[] = {"0 3 2 1", "4 5 6 7", "0 1 5 4", "1 2 6 5", "2 3 7 6", "3 0 4 7"};

std::string obj_cube(const std::string& before_faces = "", const std::string& before_each_face = "") {
  std::string obj;
  for (std::size_t at = 0; at < kCubeCorners.size(); at = kCubeCorners.find('\n', at) + 1)
    obj += "v " + kCubeCorners.substr(at, kCubeCorners.find('\n', at) + 1 - at);
  obj += before_faces;
  for (const std::string face : kCubeFaces) {
    obj += before_each_face + "f ";
    for (const char digit : face) obj += digit == ' ' ? ' ' : static_cast<char>(digit + 1);
    obj += '\n';
  }
  return obj;
}

std::string ply_header(std::size_t vertices, std::size_t faces) {
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(faces) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

class MeshNormals : public testing::Test {
 protected:
  Mesh load(const std::string& name, const std::string& text) {
    write_text(folder_ / name, text);
    return load_mesh(folder_ / name, warnings_.handler());
  }

  TempFolder folder_;
  Warnings warnings_;
};

TEST_F(MeshNormals, ObjWithoutNormalsAndSmoothingIsFlat) {
  for (const char* smoothing : {"", "s off\n", "s 0\n", "s 1\ns off\n"}) {
    const Mesh cube = load("cube.obj", obj_cube(smoothing));
    EXPECT_LT(departure_from_flat(cube), 1e-6) << smoothing;
    EXPECT_EQ(cube.vertices.size(), 24u) << "the two triangles of a side share their vertices";
  }
}

TEST_F(MeshNormals, ObjOfOneSmoothingGroupIsSmooth) {
  const Mesh cube = load("cube.obj", obj_cube("s 1\n"));
  EXPECT_EQ(cube.vertices.size(), 8u);
  for (const Vertex& vertex : cube.vertices)
    EXPECT_LT(glm::distance(vertex.normal, glm::normalize(vertex.position_m - 0.5f)), 1e-6f) << "each side counts alike";
}

TEST_F(MeshNormals, ObjGroupsMeetInEdges) {
  // A strip of four squares around a prism: the first two are smooth together, the last two too.
  const std::string corners = "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 1 0 1\nv 2 1 0\nv 2 1 1\nv 2 2 0\nv 2 2 1\nv 1 3 0\nv 1 3 1\n";
  const Mesh strip = load("strip.obj", corners + "s 1\nf 1 3 4 2\nf 3 5 6 4\ns 2\nf 5 7 8 6\nf 7 9 10 8\n");
  const auto normals_at = [&](const glm::vec3& place) {
    std::vector<glm::vec3> normals;
    for (const Vertex& vertex : strip.vertices)
      if (vertex.position_m == place) normals.push_back(vertex.normal);
    return normals;
  };
  EXPECT_EQ(normals_at({1, 0, 0}).size(), 1u) << "within a group";
  EXPECT_EQ(normals_at({2, 1, 0}).size(), 2u) << "between the groups";
  EXPECT_EQ(normals_at({2, 2, 0}).size(), 1u);
  const Mesh facets = load("cube.obj", obj_cube("", "s 1\n"));
  EXPECT_EQ(facets.vertices.size(), 8u) << "a group goes on where it is named again";
}

TEST_F(MeshNormals, NormalsOfTheFileAreKept) {
  const Mesh mesh = load("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nvn 0 0.6 0.8\nf 1//1 2//1 3\nf 2 4 3\n");
  std::size_t kept = 0;
  for (const Vertex& vertex : mesh.vertices) kept += glm::distance(vertex.normal, glm::vec3(0, 0.6f, 0.8f)) < 1e-6f;
  EXPECT_EQ(kept, 2u);
  EXPECT_EQ(mesh.vertices.size(), 6u);
}

TEST_F(MeshNormals, PlyIsSmoothWhereItBendsLittle) {
  std::string cube = ply_header(8, 6) + kCubeCorners;
  for (const std::string face : kCubeFaces) cube += "4 " + face + '\n';
  EXPECT_LT(departure_from_flat(load("cube.ply", cube)), 1e-6);

  const Mesh exact = sphere({0, 0, 0}, 1, 16);
  std::string ball = ply_header(exact.vertices.size(), exact.indices.size() / 3);
  for (const Vertex& v : exact.vertices) {
    for (int c = 0; c < 3; ++c) ball += std::to_string(v.position_m[c]) + ' ';
    ball += '\n';
  }
  for (std::size_t i = 0; i < exact.indices.size(); i += 3)
    ball += "3 " + std::to_string(exact.indices[i]) + ' ' + std::to_string(exact.indices[i + 1]) + ' ' +
            std::to_string(exact.indices[i + 2]) + '\n';
  const Mesh smooth = load("ball.ply", ball);
  for (const std::uint32_t index : smooth.indices)
    EXPECT_GT(glm::dot(smooth.vertices[index].normal, smooth.vertices[index].position_m), 0.999f);
}

TEST(MissingNormals, SurfacesThatTouchInAPointStayApart) {
  ImportedMesh imported;
  imported.mesh = box({0, 0, 0}, {1, 1, 1});
  append(imported.mesh, box({1, 1, 1}, {2, 2, 2}));
  for (Vertex& vertex : imported.mesh.vertices) vertex.normal = glm::vec3(0);
  imported.smoothing_group.assign(imported.mesh.triangle_material.size(), 1);
  make_missing_normals(imported);
  for (const std::uint32_t index : imported.mesh.indices) {
    const Vertex& vertex = imported.mesh.vertices[index];
    if (vertex.position_m != glm::vec3(1)) continue;
    EXPECT_NEAR(std::abs(glm::dot(vertex.normal, glm::vec3(1))), std::sqrt(3.0), 1e-5);
  }
}

TEST(MissingNormals, AnEdgeOfManyTrianglesIsDoneInTime) {
  ImportedMesh fan;
  fan.mesh.vertices = {{{0, 0, 0}, {}}, {{0, 0, 1}, {}}};
  fan.mesh.materials.emplace_back();
  for (std::uint32_t i = 0; i < 200'000; ++i) {
    fan.mesh.vertices.push_back({{std::cos(i * 0.1f), std::sin(i * 0.1f), 0}, {}});
    fan.mesh.indices.insert(fan.mesh.indices.end(), {0, 1, i + 2});
    fan.mesh.triangle_material.push_back(0);
  }
  make_missing_normals(fan);
  EXPECT_EQ(fan.mesh.indices.size(), 600'000u);
}

}  // namespace
}  // namespace catchlight::render
