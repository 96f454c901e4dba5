// Four floats that the compiler keeps in one register: a texel, a pixel.
#pragma once

#include <glm/glm.hpp>

namespace catchlight::render {

using Float4 = float __attribute__((vector_size(16)));

inline Float4 splat(float value) {
  return Float4{value, value, value, value};
}

inline Float4 blend(Float4 a, Float4 b, float share) {
  return a + (b - a) * splat(share);
}

inline Float4 float4(const glm::vec3& v, float w = 0) {
  return Float4{v.x, v.y, v.z, w};
}

inline glm::vec3 rgb(Float4 v) {
  return {v[0], v[1], v[2]};
}

}  // namespace catchlight::render
