#include "render/mesh/mesh_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <unordered_map>

#include "render/mesh/mesh_import.hpp"

namespace catchlight::render {
namespace {

bool is_finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

struct PositionHash {
  std::size_t operator()(const glm::vec3& p) const {
    std::size_t hash = 0;
    for (int c = 0; c < 3; ++c)
      hash = hash * 0x9e3779b97f4a7c15u + std::hash<float>()(p[c] + 0.0f);  // + 0: -0 and 0 are one place
    return hash;
  }
};

void check_positions(const std::string& path, const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!is_finite(mesh.vertices[i].position_m)) throw Error(path + ": vertex " + std::to_string(i) + " has no finite position");
  }
  const auto bad =
      std::find_if(mesh.indices.begin(), mesh.indices.end(), [&](std::uint32_t i) { return i >= mesh.vertices.size(); });
  if (bad != mesh.indices.end()) {
    throw Error(path + ": a triangle names vertex " + std::to_string(*bad) + " of " + std::to_string(mesh.vertices.size()));
  }
}

glm::dvec3 doubled_area_normal(const Mesh& mesh, std::size_t triangle) {
  const auto corner = [&](int k) { return glm::dvec3(mesh.vertices[mesh.indices[3 * triangle + k]].position_m); };
  return glm::cross(corner(1) - corner(0), corner(2) - corner(0));
}

// Triangles without area have no side: they catch no light, and their normals are noise.
void drop_degenerate_triangles(const std::string& path, Mesh& mesh, const WarningHandler& warn) {
  std::size_t kept = 0;
  const std::size_t count = mesh.triangle_material.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!(glm::length(doubled_area_normal(mesh, i)) > 0)) continue;
    std::copy_n(mesh.indices.begin() + 3 * i, 3, mesh.indices.begin() + 3 * kept);
    mesh.triangle_material[kept++] = mesh.triangle_material[i];
  }
  mesh.indices.resize(3 * kept);
  mesh.triangle_material.resize(kept);
  if (kept < count && warn) warn(path + ": " + std::to_string(count - kept) + " triangles without area are left out");
}

// Faces around one position count by area and by their angle there (Max, "Weights for Computing Vertex Normals", 1999, and
// Thuermer & Wuethrich 1998): the result does not depend on how the surface is cut into triangles.
void make_missing_normals(Mesh& mesh) {
  const auto missing = [](const Vertex& vertex) { return !is_finite(vertex.normal) || glm::length(vertex.normal) < 1e-6f; };
  if (std::none_of(mesh.vertices.begin(), mesh.vertices.end(), missing)) return;
  std::unordered_map<glm::vec3, glm::dvec3, PositionHash> normal_at;
  for (std::size_t i = 0; i < mesh.triangle_material.size(); ++i) {
    const glm::dvec3 normal = doubled_area_normal(mesh, i);
    for (int k = 0; k < 3; ++k) {
      const auto corner = [&](int c) { return glm::dvec3(mesh.vertices[mesh.indices[3 * i + (k + c) % 3]].position_m); };
      const glm::dvec3 one = glm::normalize(corner(1) - corner(0)), other = glm::normalize(corner(2) - corner(0));
      normal_at[glm::vec3(corner(0))] += normal * std::acos(std::clamp(glm::dot(one, other), -1.0, 1.0));
    }
  }
  for (Vertex& vertex : mesh.vertices) {
    if (!missing(vertex)) continue;
    const auto found = normal_at.find(vertex.position_m);
    const bool known = found != normal_at.end() && glm::length(found->second) > 0;
    vertex.normal =
        known ? glm::vec3(glm::normalize(found->second)) : glm::vec3(0, 0, 1);  // unused vertices and folded sheets: any
  }
}

}  // namespace

Mesh load_mesh(const std::string& path, const WarningHandler& warn) {
  if (!std::ifstream(path)) throw Error(path + ": cannot be opened; expected a mesh (glTF, OBJ or PLY)");
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
  Mesh mesh;
  if (extension == ".glb" || extension == ".gltf") {
    mesh = import_gltf(path, warn);
  } else if (extension == ".obj" || extension == ".ply") {
    mesh = import_with_assimp(path);
  } else {
    throw Error(path + ": expected a mesh with the ending .glb, .gltf, .obj or .ply");
  }
  check_positions(path, mesh);
  drop_degenerate_triangles(path, mesh, warn);
  if (mesh.indices.empty()) throw Error(path + ": holds no triangles");
  make_missing_normals(mesh);
  for (Vertex& vertex : mesh.vertices) vertex.normal = glm::normalize(vertex.normal);
  return mesh;
}

}  // namespace catchlight::render
