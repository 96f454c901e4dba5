#include "render/cpu/object_layers.hpp"

#include <algorithm>
#include <glm/glm.hpp>
#include <limits>

namespace catchlight::render {

Layers empty_layers(const PixelRect& frame) {
  const auto image = [&](int channels) { return Image(frame.width, frame.height, channels); };
  Layers layers{image(3), image(4), image(3), image(3), image(3), image(3), image(1)};
  std::ranges::fill(layers.depth.data, std::numeric_limits<float>::infinity());
  return layers;
}

void put_object_layers(const ObjectImages& images, Layers& layers) {
  const PixelRect& rect = images.rect;
  for (int y = 0; y < rect.height; ++y) {
    for (int x = 0; x < rect.width; ++x) {
      const float* nz = images.normal_depth.pixel(x, y);
      const glm::vec3 normal(nz[0], nz[1], nz[2]);
      if (normal == glm::vec3(0)) continue;
      const glm::vec3 unit = normal / std::max(glm::length(normal), 1e-12f);
      std::copy_n(images.reflection.pixel(x, y), 3, layers.reflection.pixel(rect.x + x, rect.y + y));
      std::copy_n(&unit.x, 3, layers.normal.pixel(rect.x + x, rect.y + y));
      *layers.depth.pixel(rect.x + x, rect.y + y) = nz[3] / nz[4];
    }
  }
}

}  // namespace catchlight::render
