#include "render/object_layers.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>

namespace catchlight::render {

Layers empty_layers(const PixelRect& frame) {
  const auto image = [&](int channels) { return Image(frame.width, frame.height, channels); };
  Layers layers{image(3), image(4), image(3), image(3), image(3), image(3), image(1)};
  std::ranges::fill(layers.depth.data, std::numeric_limits<float>::infinity());
  return layers;
}

void add_geometry(const Image& color, const Image& normal_depth, const PixelRect& rect, Layers& layers) {
  for (int y = 0; y < rect.height; ++y) {
    for (int x = 0; x < rect.width; ++x) {
      const float coverage = color.pixel(x, y)[3];
      float& depth = *layers.depth.pixel(rect.x + x, rect.y + y);
      if (coverage < kMinCoverage || std::isfinite(depth)) continue;
      const float* nz = normal_depth.pixel(x, y);
      const glm::vec3 normal(nz[0], nz[1], nz[2]), unit = normal / std::max(glm::length(normal), 1e-30f);
      std::copy_n(&unit.x, 3, layers.normal.pixel(rect.x + x, rect.y + y));
      depth = nz[3] / coverage;
    }
  }
}

}  // namespace catchlight::render
