#include "render/cpu/surface/mesh_outline.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace catchlight::render {
namespace {

/// Normals that differ by more across an edge make a crease: cosine of 5 degrees.
constexpr float kCreaseCosine = 0.996f;

/// For each vertex the first one at its position.
std::vector<std::uint32_t> vertices_by_position(const Mesh& mesh) {
  std::vector<std::uint32_t> order(mesh.vertices.size()), first(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t v) {
    const glm::vec3& p = mesh.vertices[v].position_m;
    return std::array{p.x, p.y, p.z};
  };
  std::ranges::sort(order, [&](auto a, auto b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
  return first;
}

struct HalfEdge {
  std::uint32_t low, high;  ///< positions
  std::uint32_t from, to;   ///< vertices, in the same order
  std::uint32_t triangle;
};

std::vector<HalfEdge> half_edges(const Mesh& mesh) {
  const std::vector<std::uint32_t> position = vertices_by_position(mesh);
  std::vector<HalfEdge> result;
  result.reserve(mesh.indices.size());
  for (std::uint32_t t = 0; t < mesh.indices.size() / 3; ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      std::uint32_t from = mesh.indices[3 * t + k], to = mesh.indices[3 * t + (k + 1) % 3];
      if (position[from] == position[to]) continue;
      if (position[from] > position[to]) std::swap(from, to);
      result.push_back({position[from], position[to], from, to, t});
    }
  }
  std::ranges::sort(result, [](const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return result;
}

bool differ(const Mesh& mesh, std::uint32_t a, std::uint32_t b) {
  if (a == b) return false;
  const Vertex &one = mesh.vertices[a], &other = mesh.vertices[b];
  const float lengths = glm::length(one.normal) * glm::length(other.normal);
  return !(glm::dot(one.normal, other.normal) >= kCreaseCosine * lengths) || one.color != other.color;
}

}  // namespace

MeshOutline::MeshOutline(const Mesh& mesh) : mesh_(mesh) {
  for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
    const auto corner = [&](std::size_t k) { return mesh.vertices[mesh.indices[3 * t + k]].position_m; };
    const glm::vec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
    planes_.emplace_back(normal, glm::dot(normal, corner(0)));
  }
  faces_eye_.resize(planes_.size());
  const std::vector<HalfEdge> halves = half_edges(mesh);
  for (std::size_t i = 0; i < halves.size();) {
    std::size_t end = i + 1;
    while (end < halves.size() && halves[end].low == halves[i].low && halves[end].high == halves[i].high) ++end;
    // More than two triangles at an edge: each is an outline of its own.
    const bool is_pair = end - i == 2;
    for (std::size_t k = i; k < (is_pair ? i + 1 : end); ++k) {
      const HalfEdge& a = halves[k];
      Edge edge{a.from, a.to, a.triangle, is_pair ? halves[i + 1].triangle : kNone, false};
      if (is_pair)
        edge.is_crease = mesh.triangle_material[a.triangle] != mesh.triangle_material[edge.neighbour] ||
                         differ(mesh, a.from, halves[i + 1].from) || differ(mesh, a.to, halves[i + 1].to);
      edges_.push_back(edge);
    }
    i = end;
  }
}

void MeshOutline::for_each_seen(const glm::vec3& eye_m, const std::function<void(const glm::vec3&, const glm::vec3&)>& draw) {
  for (std::size_t t = 0; t < planes_.size(); ++t) faces_eye_[t] = glm::dot(glm::vec3(planes_[t]), eye_m) > planes_[t].w;
  for (const Edge& edge : edges_) {
    const bool one = faces_eye_[edge.triangle] != 0;
    const bool other = edge.neighbour != kNone && faces_eye_[edge.neighbour] != 0;
    const bool is_seen = edge.neighbour == kNone || one != other || (edge.is_crease && (one || other));
    if (is_seen) draw(mesh_.vertices[edge.from].position_m, mesh_.vertices[edge.to].position_m);
  }
}

void for_each_crossed_pixel(const glm::dvec2& from_px, const glm::dvec2& to_px, int width, int height,
                            const std::function<void(int, int)>& mark) {
  // Clipped to the picture (Liang & Barsky), then from pixel border to pixel border (Amanatides & Woo).
  const glm::dvec2 from = from_px + 0.5, along = to_px - from_px, size(width, height);
  double begin = 0, end = 1;
  for (int axis = 0; axis < 2; ++axis) {
    if (along[axis] == 0) {
      if (!(from[axis] >= 0 && from[axis] < size[axis])) return;
      continue;
    }
    const double low = -from[axis] / along[axis], high = (size[axis] - from[axis]) / along[axis];
    begin = std::max(begin, std::min(low, high)), end = std::min(end, std::max(low, high));
  }
  if (!(begin <= end)) return;
  const glm::dvec2 first = from + begin * along;
  glm::ivec2 pixel = glm::clamp(glm::ivec2(glm::floor(first)), glm::ivec2(0), glm::ivec2(width - 1, height - 1));
  glm::dvec2 next(2.0), step(2.0);
  glm::ivec2 way(0);
  for (int axis = 0; axis < 2; ++axis) {
    if (along[axis] == 0) continue;
    way[axis] = along[axis] > 0 ? 1 : -1;
    step[axis] = 1 / std::abs(along[axis]);
    next[axis] = (pixel[axis] + (along[axis] > 0 ? 1 : 0) - from[axis]) / along[axis];
  }
  while (pixel.x >= 0 && pixel.y >= 0 && pixel.x < width && pixel.y < height) {
    mark(pixel.x, pixel.y);
    const int axis = next.x < next.y ? 0 : 1;
    if (!(next[axis] <= end)) return;
    pixel[axis] += way[axis];
    next[axis] += step[axis];
  }
}

}  // namespace catchlight::render
