// The sensor's noise, compiled as GLSL and as C++. Integers up to the last step: every machine draws the same.
#ifdef __cplusplus
#pragma once
#include <glm/glm.hpp>

namespace catchlight::render::shading {
using namespace glm;
#define PURE inline
#else
#define PURE
#endif

// pcg4d (Jarzynski & Olano 2020, "Hash Functions for GPU Rendering").
PURE uvec4 hash_of(uvec4 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.w, v.y += v.z * v.x, v.z += v.x * v.y, v.w += v.y * v.z;
  v ^= v >> 16u;
  v.x += v.y * v.w, v.y += v.z * v.x, v.z += v.x * v.y, v.w += v.y * v.z;
  return v;
}

// Mean 0, variance 1: the sum of eight uniform numbers, which is normal but for a kurtosis 0.15 too small.
PURE float gaussian(ivec2 place, uint seed, uint stream) {
  uvec4 h = hash_of(uvec4(uint(place.x), uint(place.y), seed, stream));
  uvec4 halves = (h & 0xffffu) + (h >> 16u);
  return (float(halves.x + halves.y + halves.z + halves.w) - 262140.0f) / 53509.9f;
}

// A pixel keeps the noise of what it keeps of the plate, and so needs the rest: none where nothing was touched, all of it where
// the object covers. A channel's variance = slope * light + lowest; the result is the missing noise's standard deviation.
PURE float missing_sigma(float slope, float lowest, float light, float background, float kept) {
  float wanted = max(slope * max(light, 0.0f) + lowest, 0.0f);
  float there = kept * kept * max(slope * max(background, 0.0f) + lowest, 0.0f);
  return sqrt(max(wanted - there, 0.0f));
}

#ifdef __cplusplus
#undef PURE
}  // namespace catchlight::render::shading
#endif
