#include "app/media/pixels/untouched_layers.hpp"

#include <algorithm>
#include <limits>

#include "catchlight/image.hpp"
#include "catchlight/plate.hpp"

namespace catchlight::app {
namespace {

Image filled(int width, int height, int channels, float value) {
  Image image(width, height, channels);
  std::ranges::fill(image.data, value);
  return image;
}

}  // namespace

Layers untouched_layers(const Frame& frame) {
  const int width = frame.width_px(), height = frame.height_px();
  Layers layers;
  layers.plate = Image(width, height);
  layers.plate.data = linear_rgb(frame.rgb({0, 0, width, height}), frame.color());
  layers.object = filled(width, height, 4, 0.0f);
  layers.shadow = filled(width, height, 3, 1.0f);
  layers.reflection = layers.glare = layers.normal = filled(width, height, 3, 0.0f);
  layers.depth = filled(width, height, 1, std::numeric_limits<float>::infinity());
  return layers;
}

}  // namespace catchlight::app
