// Normals for meshes that come without.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "render/mesh_file/mesh_import.hpp"

namespace catchlight::render {
namespace {

/// Triangles that a flat polygon was cut into meet at angles of rounding.
constexpr double kCoplanarDeg = 0.1;

/// An edge with many triangles is no surface's: each of them is compared with so many only.
constexpr std::size_t kMaxNeighbours = 8;

bool is_missing(const Vertex& vertex) {
  const glm::vec3& n = vertex.normal;
  return !std::isfinite(n.x + n.y + n.z) || glm::length(n) < 1e-6f;
}

struct PlaceHash {
  std::size_t operator()(const glm::vec3& p) const {
    std::size_t hash = 0;
    for (int c = 0; c < 3; ++c)
      hash = hash * 0x9e3779b97f4a7c15u + std::hash<float>()(p[c] + 0.0f);  // + 0: -0 and 0 are one place
    return hash;
  }
};

/// Corner 3 t + k is that of triangle t at mesh.indices[3 t + k].
std::uint32_t next_in_triangle(std::uint32_t corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}

glm::dvec3 position_m(const Mesh& mesh, std::uint32_t corner) {
  return mesh.vertices[mesh.indices[corner]].position_m;
}

std::vector<glm::dvec3> doubled_area_normals(const Mesh& mesh) {
  std::vector<glm::dvec3> normals;
  for (std::uint32_t corner = 0; corner < mesh.indices.size(); corner += 3) {
    const glm::dvec3 origin = position_m(mesh, corner);
    normals.push_back(glm::cross(position_m(mesh, corner + 1) - origin, position_m(mesh, corner + 2) - origin));
  }
  return normals;
}

/// A number for the place of each corner: vertices doubled along a seam are one place.
std::vector<std::uint32_t> places_of_corners(const Mesh& mesh) {
  std::unordered_map<glm::vec3, std::uint32_t, PlaceHash> known;
  std::vector<std::uint32_t> places;
  for (const std::uint32_t index : mesh.indices)
    places.push_back(known.try_emplace(mesh.vertices[index].position_m, static_cast<std::uint32_t>(known.size())).first->second);
  return places;
}

/// Corners that belong together, found by joining them two by two.
class JoinedCorners {
 public:
  explicit JoinedCorners(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

  std::uint32_t group(std::uint32_t corner) {
    while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
    return corner;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[group(a)] = group(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

/// A triangle's edge from `corner` to the next, under the same name for all triangles that have it.
struct Edge {
  std::array<std::uint32_t, 2> places;
  std::uint32_t corner;
  bool operator<(const Edge& other) const { return std::tie(places, corner) < std::tie(other.places, other.corner); }
};

std::vector<Edge> sorted_edges(const std::vector<std::uint32_t>& places) {
  std::vector<Edge> edges;
  for (std::uint32_t corner = 0; corner < places.size(); ++corner) {
    const std::uint32_t a = places[corner], b = places[next_in_triangle(corner)];
    edges.push_back({{std::min(a, b), std::max(a, b)}, corner});
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Joins the corners at both ends of every edge over which the surface goes on smoothly.
JoinedCorners smooth_corners(const ImportedMesh& imported, const std::vector<std::uint32_t>& places,
                             const std::vector<glm::dvec3>& normals) {
  const double cos_smooth = std::cos(glm::radians(std::max(imported.smooth_below_deg, kCoplanarDeg)));
  const std::vector<std::uint32_t>& groups = imported.smoothing_group;
  const auto is_smooth = [&](std::uint32_t a, std::uint32_t b) {
    if (!groups.empty() && groups[a] != 0 && groups[a] == groups[b]) return true;
    return glm::dot(normals[a], normals[b]) >= cos_smooth * glm::length(normals[a]) * glm::length(normals[b]);
  };
  const std::vector<Edge> edges = sorted_edges(places);
  JoinedCorners joined(places.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const std::size_t end = std::min(i + 1 + kMaxNeighbours, edges.size());
    for (std::size_t j = i + 1; j < end && edges[j].places == edges[i].places; ++j) {
      std::uint32_t a = edges[i].corner, b = edges[j].corner;
      if (!is_smooth(a / 3, b / 3)) continue;
      const bool same_way = places[a] == places[b];
      joined.join(a, same_way ? b : next_in_triangle(b));
      joined.join(next_in_triangle(a), same_way ? next_in_triangle(b) : b);
    }
  }
  return joined;
}

double angle_at(const Mesh& mesh, std::uint32_t corner) {
  const glm::dvec3 here = position_m(mesh, corner);
  const std::uint32_t next = next_in_triangle(corner);
  const glm::dvec3 one = glm::normalize(position_m(mesh, next) - here),
                   other = glm::normalize(position_m(mesh, next_in_triangle(next)) - here);
  return std::acos(std::clamp(glm::dot(one, other), -1.0, 1.0));
}

/// Where a vertex without normal serves several surfaces, the first of them keeps it; the others get copies.
class VertexCopies {
 public:
  explicit VertexCopies(Mesh& mesh) : mesh_(mesh), is_taken_(mesh.vertices.size()) {}

  void give(std::uint32_t corner, std::uint32_t group, const glm::vec3& normal) {
    std::uint32_t& index = mesh_.indices[corner];
    const auto [found, is_new] = made_.try_emplace(std::uint64_t{index} << 32 | group, index);
    if (is_new && is_taken_[index]) {
      found->second = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back(mesh_.vertices[index]);
      if (mesh_.has_textures()) mesh_.texture_coordinates.push_back(mesh_.texture_coordinates[index]);
    }
    if (is_new) {
      is_taken_[index] = true;
      mesh_.vertices[found->second].normal = normal;
    }
    index = found->second;
  }

 private:
  Mesh& mesh_;
  std::vector<bool> is_taken_;
  std::unordered_map<std::uint64_t, std::uint32_t> made_;
};

}  // namespace

void make_missing_normals(ImportedMesh& imported) {
  Mesh& mesh = imported.mesh;
  std::vector<bool> missing;
  for (const Vertex& vertex : mesh.vertices) missing.push_back(is_missing(vertex));
  if (std::find(missing.begin(), missing.end(), true) == missing.end()) return;
  const std::vector<glm::dvec3> normals = doubled_area_normals(mesh);
  JoinedCorners joined = smooth_corners(imported, places_of_corners(mesh), normals);
  std::vector<glm::dvec3> sum(mesh.indices.size(), glm::dvec3(0));
  for (std::uint32_t corner = 0; corner < mesh.indices.size(); ++corner)
    sum[joined.group(corner)] += normals[corner / 3] * angle_at(mesh, corner);
  VertexCopies copies(mesh);
  for (std::uint32_t corner = 0; corner < mesh.indices.size(); ++corner) {
    if (!missing[mesh.indices[corner]]) continue;
    const std::uint32_t group = joined.group(corner);
    const bool cancels = !(glm::length(sum[group]) > 0);  // folded sheets
    copies.give(corner, group, glm::vec3(glm::normalize(cancels ? normals[corner / 3] : sum[group])));
  }
  for (Vertex& vertex : mesh.vertices)
    if (is_missing(vertex)) vertex.normal = glm::vec3(0, 0, 1);  // no triangle's
}

}  // namespace catchlight::render
