// Four floats that processors compute with at once: a texel's, or a pixel's.
#pragma once

#include <cstring>
#include <glm/glm.hpp>

namespace catchlight::render {

/// RGB and a number beside it.
using Texel = float __attribute__((vector_size(16)));

inline Texel load(const float* rgba) {
  Texel texel;
  std::memcpy(&texel, rgba, sizeof texel);
  return texel;
}

inline Texel uniform(double value) {
  const auto v = static_cast<float>(value);
  return Texel{v, v, v, v};
}

inline Texel texel_of(const glm::dvec3& rgb) {
  return Texel{static_cast<float>(rgb.r), static_cast<float>(rgb.g), static_cast<float>(rgb.b), 0};
}

/// What is not a number is 0, as is what lies below.
inline Texel positive(Texel light) {
  return light > 0 ? light : Texel{};
}

inline Texel at_most(Texel light, Texel most) {
  return light < most ? light : most;
}

/// Whether any channel of RGB is above a threshold in any pixel of an RGBA row.
bool any_above(const float* rgba, int pixels, float threshold);

}  // namespace catchlight::render
