// Four floats that the compiler keeps in one register: a texel, a pixel.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <glm/glm.hpp>

namespace catchlight::render {

using Float4 = float __attribute__((vector_size(16)));

inline Float4 splat(float value) {
  return Float4{value, value, value, value};
}

/// What is not a number is 0, as is what lies below.
inline Float4 positive(Float4 values) {
  return values > 0 ? values : Float4{};
}

inline Float4 at_most(Float4 values, Float4 most) {
  return values < most ? values : most;
}

/// Whether any channel of RGB is above a threshold in any pixel of an RGBA row.
bool any_above(const float* rgba, int pixels, float threshold);

inline Float4 blend(Float4 a, Float4 b, float share) {
  return a + (b - a) * splat(share);
}

inline Float4 load(const float* values) {
  Float4 result;
  std::memcpy(&result, values, sizeof(result));
  return result;
}

inline void store(Float4 values, float* place) {
  std::memcpy(place, &values, sizeof(values));
}

inline Float4 float4(const glm::vec3& v, float w = 0) {
  return Float4{v.x, v.y, v.z, w};
}

inline glm::vec3 rgb(Float4 v) {
  return {v[0], v[1], v[2]};
}

/// Mixes what look_up(number) gives for the two of `count` levels around `level`, which is clamped to those there are.
template <typename LookUp>
Float4 between_levels(float level, std::size_t count, const LookUp& look_up) {
  const float at = std::clamp(level, 0.0f, static_cast<float>(count - 1));
  const auto finer = static_cast<std::size_t>(at);
  const float share = at - static_cast<float>(finer);
  const Float4 fine = look_up(finer);
  return share > 0 ? blend(fine, look_up(finer + 1), share) : fine;
}

}  // namespace catchlight::render
