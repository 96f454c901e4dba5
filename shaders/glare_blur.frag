// One axis of a separable blur.
#version 450 core
#include "interface.h"

#ifndef TAPS
#define TAPS MAX_GLARE_BLUR_TAPS
#endif

layout(binding = TEXTURE_SOURCE) uniform sampler2D source;
uniform ivec2 axis;
uniform float taps[TAPS];  // weights at distance 0, 1, 2 ...
layout(location = 0) out vec4 result;

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy), last = textureSize(source, 0) - 1;
  vec3 sum = taps[0] * texelFetch(source, here, 0).rgb;
  for (int d = 1; d < TAPS; ++d) {
    // What is blurred ends in the margin: beyond it there is as little as on its last texels.
    ivec2 before = max(here - d * axis, ivec2(0)), after = min(here + d * axis, last);
    sum += taps[d] * (texelFetch(source, before, 0).rgb + texelFetch(source, after, 0).rgb);
  }
  result = vec4(sum, 1.0);
}
