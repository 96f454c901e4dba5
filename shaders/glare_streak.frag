// One pass of a streak: samples that lie behind this texel, step after step.
#version 450 core
#include "interface.h"

#ifndef TAPS
#define TAPS 4
#endif
// SLANTED: between the texels of the axis across, samples are interpolated by Catmull and Rom's cubic.

layout(binding = TEXTURE_SOURCE) uniform sampler2D source;
// Few uniforms, and the rest computed: on a software rasteriser an array of weights costs as much as the reads.
uniform vec2 offset;   // offset of the source's texels from the target's
uniform vec2 pace;     // texels from one sample to the next, whole along the streak's larger axis
uniform ivec2 across;  // the other axis
uniform vec3 gain;
uniform vec3 falloff;  // factor from one sample to the next
uniform ivec4 bounds;  // first and last texel of the source that counts
layout(location = 0) out vec4 result;

vec3 light_at(ivec2 texel) {
  ivec2 inside = clamp(texel, bounds.xy, bounds.zw);
  // No branch: they cost more than the reads that they would save.
  return float(texel == inside) * texelFetch(source, inside, 0).rgb;
}

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy + offset);
  vec3 weight = gain, sum = gain * light_at(here);
  for (int s = 1; s < TAPS; ++s) {
    weight *= falloff;
    vec2 behind = float(s) * pace, whole = floor(behind);
    ivec2 first = here - ivec2(whole);
#ifdef SLANTED
    float f = dot(behind - whole, vec2(across)), f2 = f * f;
    sum += weight * (f * (-0.5 + f * (1.0 - 0.5 * f)) * light_at(first + across) + (1.0 + f2 * (-2.5 + 1.5 * f)) * light_at(first) +
                     f * (0.5 + f * (2.0 - 1.5 * f)) * light_at(first - across) + f2 * (-0.5 + 0.5 * f) * light_at(first - 2 * across));
#else
    sum += weight * light_at(first);
#endif
  }
  result = vec4(sum, 1.0);
}
