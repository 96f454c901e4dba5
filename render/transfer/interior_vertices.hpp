// Vertices that lie within another part of the object, where parts go through each other.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/mesh/mesh.hpp"

namespace catchlight::render {

/// Interior vertices take the mean of their open neighbours. What is kept at vertices is interpolated over their triangles: an
/// interior one would darken what sticks out. One without open neighbours cannot be seen and stays as it is.
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
