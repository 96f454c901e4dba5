// The sensor's noise on what is virtual.
#include "noise.h"

vec3 missing_noise(ivec2 pixel, vec3 light, vec3 background, vec3 kept) {
  ivec2 block = pixel >> composite.noise.zw;
  uint seed = uint(composite.noise.y);
  vec3 unit = mat3(composite.noise_mix) * vec3(gaussian(block, seed, 0u), gaussian(block, seed, 1u), gaussian(pixel, seed, 2u));
  for (int c = 0; c < 3; ++c)
    unit[c] *= missing_sigma(composite.noise_slope[c], composite.noise_floor[c], light[c], background[c], kept[c]);
  return unit;
}
