// The box around what is drawn.
#pragma once

#include <glm/glm.hpp>
#include <limits>

namespace catchlight::render {

struct Mesh;

/// An axis-aligned box; where it holds nothing, its least corner lies beyond its greatest.
struct Bounds {
  glm::vec3 min_m{std::numeric_limits<float>::infinity()}, max_m{-std::numeric_limits<float>::infinity()};

  bool empty() const { return !(min_m.x <= max_m.x); }
  glm::vec3 middle_m() const { return (min_m + max_m) * 0.5f; }
  float diagonal_m() const { return glm::distance(min_m, max_m); }
  /// The diagonal in double precision before it is rounded: its last bit shows in shadow maps and in where rays start.
  float rounded_diagonal_m() const { return static_cast<float>(glm::distance(glm::dvec3(min_m), glm::dvec3(max_m))); }

  void add(const Bounds& other) { min_m = glm::min(min_m, other.min_m), max_m = glm::max(max_m, other.max_m); }
};

/// The box around a mesh's triangles.
Bounds bounds_of(const Mesh& mesh);

/// The box around one triangle.
Bounds triangle_bounds(const Mesh& mesh, std::size_t triangle);

}  // namespace catchlight::render
