// Rays against all triangles, one after the other.
#pragma once

#include "render/mesh/mesh.hpp"

namespace catchlight::render::test {

/// Whether the ray meets any triangle, from either side (Moeller & Trumbore 1997).
inline bool meets_any(const Mesh& mesh, const glm::dvec3& origin_m, const glm::dvec3& direction) {
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::dvec3 a(mesh.vertices[mesh.indices[i]].position_m), b(mesh.vertices[mesh.indices[i + 1]].position_m),
        c(mesh.vertices[mesh.indices[i + 2]].position_m);
    const glm::dvec3 p = glm::cross(direction, c - a), from_a = origin_m - a, q = glm::cross(from_a, b - a);
    const double determinant = glm::dot(b - a, p);
    if (determinant == 0) continue;
    const double u = glm::dot(from_a, p) / determinant, v = glm::dot(direction, q) / determinant;
    if (u >= 0 && v >= 0 && u + v <= 1 && glm::dot(c - a, q) / determinant > 0) return true;
  }
  return false;
}

}  // namespace catchlight::render::test
