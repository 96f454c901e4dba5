// What the sensor cannot hold, from the object's light on the glare grid. Discards texels without any, so that a query tells whether
// glare is needed.
#version 450 core
#include "interface.h"

layout(binding = TEXTURE_SOURCE) uniform sampler2D filtered;
layout(location = 0) uniform float threshold;
layout(location = 1) uniform float brightest;
layout(location = 2) uniform float emitter_strength;
layout(location = 0) out vec4 excess;
layout(location = 1) out vec4 emitted;

const float kBinomial[5] = float[](0.0625, 0.25, 0.375, 0.25, 0.0625);

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy), size = textureSize(filtered, 0);
  float highest = 0.0, mean = 0.0;
  for (int y = -2; y <= 2; ++y) {
    for (int x = -2; x <= 2; ++x) {
      ivec2 texel = here + ivec2(x, y);
      if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, size))) continue;
      vec3 there = texelFetch(filtered, texel, 0).rgb;
      float peak = max(there.r, max(there.g, there.b));
      highest = max(highest, peak);
      mean += kBinomial[x + 2] * kBinomial[y + 2] * peak;
    }
  }
  vec4 found = texelFetch(filtered, here, 0);
  // The gate opens for all of a highlight at once, and once open lets its light through in proportion: a threshold on each texel
  // would take another share of it wherever it falls on the grid. The mean, not the texel, is held down for the same reason.
  vec3 kept = found.rgb * smoothstep(threshold, 1.5 * threshold, highest) / (1.0 + mean / brightest);
  if (!any(greaterThan(kept, vec3(0.0)))) discard;
  float share = clamp(found.a / dot(found.rgb, vec3(1.0)), 0.0, 1.0);
  emitted = vec4(share * emitter_strength * kept, 1.0);
  excess = vec4((1.0 - share) * kept, 1.0) + emitted;
}
