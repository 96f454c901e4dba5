// What the sensor cannot hold of the object, at half resolution. Discards texels without any, so that a query tells whether glare is needed.
#version 450 core
#include "interface.h"

layout(binding = TEXTURE_OBJECT) uniform sampler2D object;  // premultiplied exposed linear
layout(location = 0) uniform ivec4 virtual_rect;            // what `object` holds, pixels of the frame
layout(location = 1) uniform float threshold;

layout(location = 0) out vec4 bright;

// Half floats end at 65504: a brighter highlight glares as this one does.
const float kBrightest = 6e4;

// The excess sets in softly (quadratic over the first half threshold) and keeps the colour's ratio.
vec3 excess(ivec2 pixel) {
  ivec2 local = pixel - virtual_rect.xy;
  if (any(lessThan(local, ivec2(0))) || any(greaterThanEqual(local, virtual_rect.zw))) return vec3(0.0);
  vec3 light = texelFetch(object, local, 0).rgb;
  float peak = max(light.r, max(light.g, light.b)), knee = 0.5 * threshold, over = peak - threshold;
  if (!(over > 0.0)) return vec3(0.0);
  float kept = over < knee ? over * over / (2.0 * knee) : over - 0.5 * knee;
  return light * (min(kept, kBrightest) / peak);
}

void main() {
  // A tent over 4 x 4 pixels, linear in the light: a highlight that moves by part of a pixel keeps its energy.
  ivec2 first = 2 * ivec2(gl_FragCoord.xy) - 1;
  const float weights[4] = float[](0.125, 0.375, 0.375, 0.125);
  vec3 sum = vec3(0.0);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) sum += weights[x] * weights[y] * excess(first + ivec2(x, y));
  }
  if (sum == vec3(0.0)) discard;
  bright = vec4(sum, 1.0);
}
