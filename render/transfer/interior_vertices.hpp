// Vertices that lie within another part of the object, where parts go through each other.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/mesh/mesh.hpp"

namespace catchlight::render {

/// What is kept at vertices is interpolated over their triangles: one that lies within another part would darken what sticks out
/// of it. So it takes the mean of its open neighbours; without any, its triangles cannot be seen and it stays as it is.
class InteriorVertices {
 public:
  /// `is_interior`: a value a vertex, nonzero where the vertex lies within another part.
  InteriorVertices(const Mesh& mesh, const std::vector<char>& is_interior);

  /// `values`: the same number a vertex.
  void fill(std::span<glm::vec3> values) const;

 private:
  struct Vertex {
    std::uint32_t vertex;
    std::vector<std::uint32_t> open_neighbours;
  };
  std::size_t vertices_;
  std::vector<Vertex> interior_;
};

}  // namespace catchlight::render
