// One pass of a streak: weighted texels behind this one.
#version 450 core
#include "interface.h"

#ifndef TAPS
#define TAPS MAX_STREAK_TAPS
#endif

layout(binding = TEXTURE_SOURCE) uniform sampler2D source;
layout(location = 0) uniform ivec2 offsets[TAPS];
layout(location = MAX_STREAK_TAPS) uniform vec3 weights[TAPS];
layout(location = 0) out vec4 result;

void main() {
  ivec2 last = textureSize(source, 0) - 1;
  vec3 sum = vec3(0.0);
  for (int t = 0; t < TAPS; ++t) {
    ivec2 texel = ivec2(gl_FragCoord.xy) - offsets[t], inside = clamp(texel, ivec2(0), last);
    // No branch: they cost more than the reads that they would save.
    sum += float(texel == inside) * weights[t] * texelFetch(source, inside, 0).rgb;
  }
  result = vec4(sum, 1.0);
}
