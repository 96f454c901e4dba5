// Whether any pixel of a tile of the glare grid is above the threshold.
#version 450 core
#include "interface.h"

#ifndef TAPS
#define TAPS GLARE_TILE  // pixels of a tile along an axis, rounded up
#endif

layout(binding = TEXTURE_SOURCE) uniform sampler2D source;
uniform ivec2 first_pixel;  // pixel of the frame that the source's texel 0 holds
uniform ivec2 source_size;  // how much of the source is filled
uniform float texel_px;
uniform float threshold;
layout(location = 0) out float result;

void main() {
  ivec2 first = ivec2(ceil(vec2(ivec2(gl_FragCoord.xy) * GLARE_TILE - GLARE_MARGIN) * texel_px - 0.5)) - first_pixel;
  vec3 brightest = vec3(0.0);
  for (int y = 0; y < TAPS; ++y) {
    int row = clamp(first.y + y, 0, source_size.y - 1);
    for (int x = 0; x < TAPS; ++x) {
      vec3 light = texelFetch(source, ivec2(clamp(first.x + x, 0, source_size.x - 1), row), 0).rgb;
      brightest = mix(brightest, light, greaterThan(light, brightest));  // NaN is not
    }
  }
  result = any(greaterThan(brightest, vec3(threshold))) ? 1.0 : 0.0;
}
