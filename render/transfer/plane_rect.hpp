// Rectangles of the receiving plane.
#pragma once

#include <glm/glm.hpp>

namespace catchlight::render {

/// Rectangle of the tag's plane: tag x, y. Empty where min is not below max.
struct PlaneRect {
  glm::vec2 min_m{0}, max_m{0};
  bool empty() const { return !(min_m.x < max_m.x && min_m.y < max_m.y); }
};

inline PlaneRect unite(const PlaneRect& a, const PlaneRect& b) {
  return {glm::min(a.min_m, b.min_m), glm::max(a.max_m, b.max_m)};
}

}  // namespace catchlight::render
