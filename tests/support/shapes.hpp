// Meshes for tests, one white Lambertian material.
#pragma once

#include <cmath>
#include <numbers>
#include <set>

#include "render/mesh/mesh.hpp"

namespace catchlight::render {

inline Material white() {
  Material material;
  material.base_color = glm::vec3(1);
  return material;
}

inline void add_triangle(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  mesh.indices.insert(mesh.indices.end(), {a, b, c});
  mesh.triangle_material.push_back(0);
}

/// Black: casts shadows, and costs no rays of its own.
inline Mesh blackened(Mesh mesh) {
  for (Material& material : mesh.materials) material.base_color = glm::vec3(0);
  return mesh;
}

/// The vertices that triangles use.
inline std::set<std::uint32_t> used_vertices(const Mesh& mesh) {
  return {mesh.indices.begin(), mesh.indices.end()};
}

/// Flat quadrilateral, counter-clockwise seen from outside.
inline void add_quad(Mesh& mesh, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
  if (mesh.materials.empty()) mesh.materials.push_back(white());
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  const glm::vec3 normal = glm::normalize(glm::cross(b - a, d - a));
  for (const glm::vec3& p : {a, b, c, d}) mesh.vertices.push_back({p, normal});
  add_triangle(mesh, base, base + 1, base + 2);
  add_triangle(mesh, base, base + 2, base + 3);
}

/// Axis-parallel box with hard edges.
inline Mesh box(const glm::vec3& low, const glm::vec3& high) {
  Mesh mesh;
  const auto p = [&](int x, int y, int z) { return glm::vec3(x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z); };
  add_quad(mesh, p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1));
  add_quad(mesh, p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0));
  add_quad(mesh, p(0, 1, 0), p(0, 1, 1), p(1, 1, 1), p(1, 1, 0));
  add_quad(mesh, p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1));
  add_quad(mesh, p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1));
  add_quad(mesh, p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), p(1, 0, 0));
  return mesh;
}

/// Smooth sphere of `rows` x 2 `rows` quadrilaterals with exact normals; `inward` turns it inside out.
inline Mesh sphere(const glm::vec3& middle, float radius, int rows, bool inward = false) {
  Mesh mesh;
  mesh.materials.push_back(white());
  const int columns = 2 * rows;
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) {
      const double theta = std::numbers::pi * row / rows, phi = 2 * std::numbers::pi * (column % columns) / columns;
      const double sine = row % rows == 0 ? 0 : std::sin(theta);  // a pole is one place
      const glm::vec3 out(sine * std::cos(phi), sine * std::sin(phi), std::cos(theta));
      mesh.vertices.push_back({middle + radius * out, inward ? -out : out});
    }
  }
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const std::uint32_t a = row * (columns + 1) + column, b = a + columns + 1;
      if (row > 0) inward ? add_triangle(mesh, a, a + 1, b) : add_triangle(mesh, a, b, a + 1);
      if (row + 1 < rows) inward ? add_triangle(mesh, a + 1, b + 1, b) : add_triangle(mesh, a + 1, b, b + 1);
    }
  }
  return mesh;
}

/// Horizontal disc of `corners` triangles, facing down.
inline Mesh disc(const glm::vec3& middle, float radius, int corners) {
  Mesh mesh;
  mesh.materials.push_back(white());
  mesh.vertices.push_back({middle, {0, 0, -1}});
  for (int k = 0; k < corners; ++k) {
    const double phi = 2 * std::numbers::pi * k / corners;
    mesh.vertices.push_back({middle + radius * glm::vec3(std::cos(phi), std::sin(phi), 0), {0, 0, -1}});
  }
  for (int k = 0; k < corners; ++k) add_triangle(mesh, 0, 1 + (k + 1) % corners, 1 + k);
  return mesh;
}

}  // namespace catchlight::render
