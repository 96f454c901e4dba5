// Four floats that the compiler keeps in one register: a texel, a pixel.
#pragma once

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

}  // namespace catchlight::render
