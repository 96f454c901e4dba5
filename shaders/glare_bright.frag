// What the sensor cannot hold, from the object's light on the glare grid. Discards texels without any, so that a query tells whether
// glare is needed.
#version 450 core
#include "interface.h"

layout(binding = TEXTURE_SOURCE) uniform sampler2D filtered;
uniform float threshold;
uniform float brightest;
uniform float emitter_strength;
layout(location = 0) out vec4 excess;
layout(location = 1) out vec4 excess_reflected;  // its two parts
layout(location = 2) out vec4 excess_emitted;

const float kBinomial[5] = float[](0.0625, 0.25, 0.375, 0.25, 0.0625);

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy), last = textureSize(filtered, 0) - 1;
  vec4 found = texelFetch(filtered, here, 0);
  if (found.rgb == vec3(0.0)) discard;
  float highest = 0.0, mean = 0.0;
  for (int y = -2; y <= 2; ++y) {
    for (int x = -2; x <= 2; ++x) {
      vec3 there = texelFetch(filtered, clamp(here + ivec2(x, y), ivec2(0), last), 0).rgb;  // black in the margin
      float peak = max(there.r, max(there.g, there.b));
      highest = max(highest, peak);
      mean += kBinomial[x + 2] * kBinomial[y + 2] * peak;
    }
  }
  // The gate opens for all of a highlight at once, and once open lets its light through in proportion: a threshold on each texel
  // would take another share of it wherever it falls on the grid. The mean, not the texel, is held down for the same reason.
  vec3 kept = found.rgb * smoothstep(threshold, 1.5 * threshold, highest) / (1.0 + mean / brightest);
  float emitted = clamp(found.a / max(dot(found.rgb, vec3(1.0)), 1e-30), 0.0, 1.0);
  excess_reflected = vec4((1.0 - emitted) * kept, 1.0);
  excess_emitted = vec4(emitter_strength * emitted * kept, 1.0);
  excess = excess_reflected + excess_emitted;
  if (!any(greaterThan(excess.rgb, vec3(0.0)))) discard;
}
