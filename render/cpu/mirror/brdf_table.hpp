// The environment's share of what a surface mirrors, looked up.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>

#include "catchlight/image.hpp"
#include "render/probe/prefilter.hpp"

namespace catchlight::render {

/// Scale and bias of F0 by (n.v, perceptual roughness), linear between texels.
class BrdfTable {
 public:
  /// `is_used`: else it is left empty.
  explicit BrdfTable(bool is_used = true) : table_(is_used ? environment_brdf_table(kSize) : Image()) {}

  glm::vec2 at(float n_v, float roughness) const {
    const glm::vec2 place = glm::clamp(glm::vec2(n_v, roughness), 0.0f, 1.0f) * float{kSize} - 0.5f;
    const glm::vec2 inside = glm::clamp(place, 0.0f, kSize - 1.0f);
    const int x = static_cast<int>(inside.x), y = static_cast<int>(inside.y);
    const int right = std::min(x + 1, kSize - 1), below = std::min(y + 1, kSize - 1);
    const glm::vec2 f = inside - glm::vec2(x, y);
    const auto texel = [&](int i, int j) { return glm::vec2(table_.pixel(i, j)[0], table_.pixel(i, j)[1]); };
    return glm::mix(glm::mix(texel(x, y), texel(right, y), f.x), glm::mix(texel(x, below), texel(right, below), f.x), f.y);
  }

 private:
  static constexpr int kSize = 64;
  Image table_;
};

}  // namespace catchlight::render
