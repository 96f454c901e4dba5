#include "render/passes/object_layers.hpp"

#include <algorithm>
#include <limits>

#include "catchlight/image.hpp"

namespace catchlight::render {

void read_object_layers(const ObjectTarget* target, const PixelRect& rect, const PixelRect& frame, Layers& layers) {
  layers.reflection = Image(frame.width, frame.height, 3);
  layers.normal = Image(frame.width, frame.height, 3);
  layers.depth = Image(frame.width, frame.height, 1);
  std::fill(layers.depth.data.begin(), layers.depth.data.end(), std::numeric_limits<float>::infinity());
  if (rect.empty()) return;
  const auto read = [&](int layer) { return target->read(layer, rect.width, rect.height); };
  const Image color = read(0), reflection = read(1), normal_depth = read(2);
  for (int y = 0; y < rect.height; ++y) {
    for (int x = 0; x < rect.width; ++x) {
      const float coverage = color.pixel(x, y)[3];
      if (coverage <= 0.0f) continue;
      const float* nz = normal_depth.pixel(x, y);
      const glm::vec3 normal(nz[0], nz[1], nz[2]);
      const glm::vec3 unit = normal / std::max(glm::length(normal), 1e-12f);
      std::copy_n(reflection.pixel(x, y), 3, layers.reflection.pixel(rect.x + x, rect.y + y));
      std::copy_n(&unit.x, 3, layers.normal.pixel(rect.x + x, rect.y + y));
      *layers.depth.pixel(rect.x + x, rect.y + y) = nz[3] / coverage;
    }
  }
}

}  // namespace catchlight::render
