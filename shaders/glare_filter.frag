// The object's light on the glare grid, one axis at a time: each pixel is dealt out by a cubic B-spline one texel wide, whose
// weights sum to 1 wherever the pixel lies, so that a highlight that moves by part of a texel keeps its energy.
#version 450 core
#include "interface.h"

#ifndef TAPS
#define TAPS 9  // pixels under a B-spline: 4 texels and what begins within
#endif
// AXIS: 0 along the rows, 1 down the columns. EMISSION: the rows pass takes the object's own light along in a.
#ifndef AXIS
#define AXIS 0
#endif

layout(binding = TEXTURE_SOURCE) uniform sampler2D source;      // rgb; in the second pass also a, the emitted part
layout(binding = TEXTURE_EMISSION) uniform sampler2D emission;  // rgb of the object's own light
uniform int first_pixel;  // pixel of the frame that the source's texel 0 holds along the axis
uniform int source_size;  // how much of the source is filled along it
uniform float texel_px;
layout(location = 0) out vec4 result;

float bspline_weight(float d) {
  float x = abs(d), y = max(2.0 - x, 0.0);
  return x < 1.0 ? (4.0 - 6.0 * x * x + 3.0 * x * x * x) / 6.0 : y * y * y / 6.0;
}

vec3 usable(vec3 light) { return mix(vec3(0.0), min(light, vec3(1e9)), greaterThan(light, vec3(0.0))); }

vec4 light_at(ivec2 texel) {
  vec4 light = texelFetch(source, texel, 0);
#if AXIS == 0
  light.rgb = usable(light.rgb);
#ifdef EMISSION
  light.a = dot(usable(texelFetch(emission, texel, 0).rgb), vec3(1.0));
#else
  light.a = 0.0;
#endif
#endif
  return light;
}

void main() {
  // Along the axis gl_FragCoord counts texels of the grid, across it what the source counts.
  ivec2 here = ivec2(gl_FragCoord.xy);
  float middle = float(here[AXIS] - GLARE_MARGIN) + 0.5;
  int first = int(ceil((middle - 2.0) * texel_px - 0.5)) - first_pixel;
  vec4 sum = vec4(0.0);
  for (int t = 0; t < TAPS; ++t) {
    int i = first + t, inside = clamp(i, 0, source_size - 1);
    float weight = i == inside ? bspline_weight((float(i + first_pixel) + 0.5) / texel_px - middle) / texel_px : 0.0;
    sum += weight * light_at(AXIS == 0 ? ivec2(inside, here.y) : ivec2(here.x, inside));
  }
  result = sum;
}
