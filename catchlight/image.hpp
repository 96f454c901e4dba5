// A float image in memory.
#pragma once

#include <cstddef>
#include <span>

#include "catchlight/util/raw_vector.hpp"

namespace catchlight {

/// Row-major, top row first, `channels` interleaved floats a pixel. Colour is scene-linear Rec. 709 unless a name says otherwise.
struct Image {
  int width = 0, height = 0, channels = 3;
  RawVector<float> data;

  Image() = default;
  Image(int width_, int height_, int channels_ = 3)
      : width(width_), height(height_), channels(channels_), data(static_cast<std::size_t>(width_) * height_ * channels_, 0.0f) {}

  float* pixel(int x, int y) { return &data[(static_cast<std::size_t>(y) * width + x) * channels]; }
  const float* pixel(int x, int y) const { return &data[(static_cast<std::size_t>(y) * width + x) * channels]; }
};

}  // namespace catchlight
