#include "render/transfer/interior_vertices.hpp"

#include <algorithm>
#include <map>

namespace catchlight::render {

InteriorVertices::InteriorVertices(const Mesh& mesh, const std::vector<char>& is_interior) : vertices_(mesh.vertices.size()) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> neighbours;
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    if (!is_interior[mesh.indices[i]]) continue;
    for (std::size_t k = i / 3 * 3; k < i / 3 * 3 + 3; ++k)
      if (!is_interior[mesh.indices[k]]) neighbours[mesh.indices[i]].push_back(mesh.indices[k]);
  }
  for (auto& [vertex, open] : neighbours) {
    std::ranges::sort(open);
    const auto repeated = std::ranges::unique(open);
    open.erase(repeated.begin(), repeated.end());
    interior_.push_back({vertex, std::move(open)});
  }
}

void InteriorVertices::fill(std::span<glm::vec3> values) const {
  const std::size_t count = values.size() / std::max<std::size_t>(vertices_, 1);
  for (const Vertex& one : interior_) {
    for (std::size_t i = 0; i < count; ++i) {
      glm::vec3 sum(0);
      for (const std::uint32_t neighbour : one.open_neighbours) sum += values[neighbour * count + i];
      values[one.vertex * count + i] = sum / static_cast<float>(one.open_neighbours.size());
    }
  }
}

}  // namespace catchlight::render
