// One axis of a separable blur.
#version 450 core
#include "interface.h"

layout(binding = TEXTURE_SOURCE) uniform sampler2D source;
layout(location = 0) uniform ivec2 axis;
layout(location = 1) uniform int count;
layout(location = 2) uniform float taps[MAX_GLARE_BLUR_TAPS];  // at distance 0, 1, 2 ...
layout(location = 0) out vec4 result;

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy), last = textureSize(source, 0) - 1;
  vec3 sum = taps[0] * texelFetch(source, here, 0).rgb;
  for (int d = 1; d < count; ++d) {
    ivec2 before = here - d * axis, after = here + d * axis;
    if (all(greaterThanEqual(before, ivec2(0)))) sum += taps[d] * texelFetch(source, before, 0).rgb;
    if (all(lessThanEqual(after, last))) sum += taps[d] * texelFetch(source, after, 0).rgb;
  }
  result = vec4(sum, 1.0);
}
