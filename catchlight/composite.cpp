#include "catchlight/composite.hpp"

namespace catchlight {

Image recompose(const Layers& layers) {
  Image rgba(layers.plate.width, layers.plate.height, 4);
  const std::size_t pixels = static_cast<std::size_t>(rgba.width) * rgba.height;
  for (std::size_t i = 0; i < pixels; ++i) {
    const float uncovered = 1.0f - layers.object.data[4 * i + 3];
    for (std::size_t c = 0; c < 3; ++c)
      rgba.data[4 * i + c] = layers.plate.data[3 * i + c] * layers.shadow.data[3 * i + c] * uncovered +
                             layers.object.data[4 * i + c] + layers.glare.data[3 * i + c];
    rgba.data[4 * i + 3] = 1.0f;
  }
  return rgba;
}

}  // namespace catchlight
