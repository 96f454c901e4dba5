// The part of the receiving plane (tag z = 0) that the object's shadow may reach, as a regular grid of points.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "render/mesh/mesh.hpp"

namespace catchlight::render {

struct ReceiverGrid {
  glm::vec2 min_m{0}, max_m{0};  ///< tag x, y of the first and last points
  int columns = 0, rows = 0;     ///< points; 0: no receiver

  std::size_t points() const { return static_cast<std::size_t>(columns) * rows; }
  glm::vec2 place_m(std::size_t point) const;
  /// The point nearest to the place; empty beyond the outermost points.
  std::optional<std::size_t> nearest(const glm::vec2& place_m) const;
};

/// A grid that covers where the shadow matters: the mesh's footprint widened with its height.
ReceiverGrid receiver_grid_for(const Mesh& mesh_tag, int points_across);

/// Points covered by the object are never seen, but those beside them are blended with them along the contact line: the ones next
/// to the border take the mean of their open neighbours, so that neither darkness nor light leaks out. `values`: the same number
/// a point.
void fill_covered(const ReceiverGrid& grid, std::vector<char> covered, std::span<glm::vec3> values);

/// Towards the grid's rim the values go over to `beyond` (one point's values): no border shows.
void fade_rim(const ReceiverGrid& grid, std::span<const glm::vec3> beyond, std::span<glm::vec3> values);

}  // namespace catchlight::render
