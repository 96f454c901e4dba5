#include "render/mesh/bounds.hpp"

#include "render/mesh/mesh.hpp"

namespace catchlight::render {

Bounds bounds_of(const Mesh& mesh) {
  Bounds bounds;
  for (std::size_t triangle = 0; triangle < mesh.indices.size() / 3; ++triangle) bounds.add(triangle_bounds(mesh, triangle));
  return bounds;
}

Bounds triangle_bounds(const Mesh& mesh, std::size_t triangle) {
  const std::uint32_t* corner = &mesh.indices[3 * triangle];
  const glm::vec3 a = mesh.vertices[corner[0]].position_m, b = mesh.vertices[corner[1]].position_m,
                  c = mesh.vertices[corner[2]].position_m;
  return {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
}

}  // namespace catchlight::render
