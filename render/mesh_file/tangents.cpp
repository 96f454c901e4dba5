#include "render/mesh_file/tangents.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>

namespace catchlight::render {
namespace {

constexpr float kNone = 0;

/// Vertices that are alike are one for their tangents, however often the file has them: position, normal, uv, handedness.
using Likeness = std::array<std::uint32_t, 9>;

struct LikenessHash {
  std::size_t operator()(const Likeness& words) const {
    std::size_t hash = 0;
    for (const std::uint32_t word : words) hash = (hash ^ word) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
    return hash;
  }
};

glm::vec2 place_of(const Mesh& mesh, std::uint32_t corner) {
  const MaterialTexture& use = mesh.materials[mesh.triangle_material[corner / 3]].normal_texture;
  return {use.uv_transform * glm::vec3(mesh.texture_coordinates[mesh.indices[corner]].uv[static_cast<std::size_t>(use.set)], 1)};
}

/// The direction along u in a triangle, of length 1, and whether the picture is mirrored there (-1) or not (1).
struct TriangleTangent {
  glm::dvec3 along_u{0};
  float handedness = kNone;  ///< none where the texture coordinates span no area
};

TriangleTangent tangent_of_triangle(const Mesh& mesh, std::uint32_t first) {
  const auto position = [&](std::uint32_t k) { return glm::dvec3(mesh.vertices[mesh.indices[first + k]].position_m); };
  const glm::dvec2 origin(place_of(mesh, first)), one = glm::dvec2(place_of(mesh, first + 1)) - origin,
                                                  other = glm::dvec2(place_of(mesh, first + 2)) - origin;
  const double area = one.x * other.y - one.y * other.x;
  const glm::dvec3 along_u =
      (other.y * (position(1) - position(0)) - one.y * (position(2) - position(0))) * (area < 0 ? -1.0 : 1.0);
  const double length = glm::length(along_u);
  if (area == 0 || !(length > 0) || !std::isfinite(length)) return {};
  return {along_u / length, area < 0 ? 1.0f : -1.0f};  // v runs down in the picture
}

glm::dvec3 perpendicular(const glm::dvec3& direction, const glm::dvec3& normal) {
  const glm::dvec3 rest = direction - glm::dot(direction, normal) * normal;
  const double length = glm::length(rest);
  return length > 1e-12 ? rest / length : glm::dvec3(0);
}

glm::dvec3 any_perpendicular(const glm::dvec3& normal) {
  return perpendicular(std::abs(normal.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0), normal);
}

class TangentMaker {
 public:
  explicit TangentMaker(Mesh& mesh) : mesh_(mesh) {
    for (std::uint32_t corner = 0; corner < mesh.indices.size(); corner += 3)
      triangles_.push_back(is_mapped(corner) ? tangent_of_triangle(mesh, corner) : TriangleTangent());
  }

  void run() {
    std::vector<bool> is_missing;
    for (const TextureCoordinates& place : mesh_.texture_coordinates)
      is_missing.push_back(glm::vec3(place.tangent) == glm::vec3(0));
    for (std::uint32_t corner = 0; corner < mesh_.indices.size(); ++corner) add(corner);
    for (std::uint32_t corner = 0; corner < mesh_.indices.size(); ++corner)
      if (triangles_[corner / 3].handedness != kNone && is_missing[mesh_.indices[corner]]) give(corner);
    for (std::uint32_t corner = 0; corner < mesh_.indices.size(); ++corner) give_any(corner);
  }

 private:
  bool is_mapped(std::uint32_t corner) const {
    return mesh_.materials[mesh_.triangle_material[corner / 3]].normal_texture.is_used();
  }

  Likeness likeness(std::uint32_t corner) const {
    const Vertex& vertex = mesh_.vertices[mesh_.indices[corner]];
    const glm::vec2 uv = place_of(mesh_, corner);
    const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value + 0.0f); };  // -0 and 0 are one
    return {bits(vertex.position_m.x),
            bits(vertex.position_m.y),
            bits(vertex.position_m.z),
            bits(vertex.normal.x),
            bits(vertex.normal.y),
            bits(vertex.normal.z),
            bits(uv.x),
            bits(uv.y),
            bits(triangles_[corner / 3].handedness)};
  }

  void add(std::uint32_t corner) {
    const TriangleTangent& triangle = triangles_[corner / 3];
    if (triangle.handedness == kNone) return;
    const std::uint32_t next = corner % 3 == 2 ? corner - 2 : corner + 1, last = corner % 3 == 0 ? corner + 2 : corner - 1;
    const Vertex& here = mesh_.vertices[mesh_.indices[corner]];
    const auto towards = [&](std::uint32_t other) {
      return perpendicular(glm::dvec3(mesh_.vertices[mesh_.indices[other]].position_m) - glm::dvec3(here.position_m),
                           here.normal);
    };
    const double angle = std::acos(std::clamp(glm::dot(towards(next), towards(last)), -1.0, 1.0));
    sums_[likeness(corner)] += angle * perpendicular(triangle.along_u, here.normal);
  }

  /// The first handedness that a vertex gets is its own; a copy gets the other.
  void give(std::uint32_t corner) {
    const float handedness = triangles_[corner / 3].handedness;
    const glm::dvec3 normal = mesh_.vertices[mesh_.indices[corner]].normal;
    glm::dvec3 tangent = perpendicular(sums_[likeness(corner)], normal);
    if (tangent == glm::dvec3(0)) tangent = any_perpendicular(normal);
    std::uint32_t& index = mesh_.indices[corner];
    if (mesh_.texture_coordinates[index].tangent.w == -handedness) {
      const auto [found, is_new] = copies_.try_emplace(index, static_cast<std::uint32_t>(mesh_.vertices.size()));
      if (is_new) {
        mesh_.vertices.push_back(Vertex(mesh_.vertices[index]));
        mesh_.texture_coordinates.push_back(TextureCoordinates(mesh_.texture_coordinates[index]));
      }
      index = found->second;
    }
    mesh_.texture_coordinates[index].tangent = glm::vec4(glm::vec3(tangent), handedness);
  }

  void give_any(std::uint32_t corner) {
    glm::vec4& tangent = mesh_.texture_coordinates[mesh_.indices[corner]].tangent;
    if (is_mapped(corner) && glm::vec3(tangent) == glm::vec3(0))
      tangent = glm::vec4(glm::vec3(any_perpendicular(mesh_.vertices[mesh_.indices[corner]].normal)), 1);
  }

  Mesh& mesh_;
  std::vector<TriangleTangent> triangles_;
  std::unordered_map<Likeness, glm::dvec3, LikenessHash> sums_;
  std::unordered_map<std::uint32_t, std::uint32_t> copies_;  ///< of vertices between handednesses
};

}  // namespace

void make_missing_tangents(Mesh& mesh) {
  const bool is_any_mapped = std::any_of(mesh.materials.begin(), mesh.materials.end(),
                                         [](const auto& material) { return material.normal_texture.is_used(); });
  if (is_any_mapped && mesh.has_textures()) TangentMaker(mesh).run();
}

}  // namespace catchlight::render
