// The object's light on the glare grid, one axis at a time: each pixel is dealt out by a cubic B-spline one texel wide, whose
// weights sum to 1 wherever the pixel lies, so that a highlight that moves by part of a texel keeps its energy.
#version 450 core
#include "interface.h"

layout(binding = TEXTURE_SOURCE) uniform sampler2D source;      // rgb; in the second pass also a, the emitted part
layout(binding = TEXTURE_EMISSION) uniform sampler2D emission;  // rgb of the object's own light
layout(location = 0) uniform ivec2 axis;
layout(location = 1) uniform ivec2 first_pixel;    // of the frame, that the source's texel (0, 0) holds along the axis
layout(location = 2) uniform ivec2 source_size;    // how much of the source is filled
layout(location = 3) uniform float texel_px;
layout(location = 4) uniform bool has_emission;
layout(location = 0) out vec4 result;

float bspline_weight(float d) {
  float x = abs(d), y = max(2.0 - x, 0.0);
  return x < 1.0 ? (4.0 - 6.0 * x * x + 3.0 * x * x * x) / 6.0 : y * y * y / 6.0;
}

vec3 usable(vec3 light) { return mix(vec3(0.0), min(light, vec3(1e9)), greaterThan(light, vec3(0.0))); }

void main() {
  // Along the axis gl_FragCoord counts texels of the grid, across it what the source counts.
  ivec2 here = ivec2(gl_FragCoord.xy);
  int along = axis.x != 0 ? here.x : here.y;
  int start = axis.x != 0 ? first_pixel.x : first_pixel.y, size = axis.x != 0 ? source_size.x : source_size.y;
  float middle = float(along - GLARE_MARGIN) + 0.5;
  int first = max(int(ceil((middle - 2.0) * texel_px - 0.5)) - start, 0);
  int last = min(int(floor((middle + 2.0) * texel_px - 0.5)) - start, size - 1);
  vec4 sum = vec4(0.0);
  for (int i = first; i <= last; ++i) {
    ivec2 texel = axis.x != 0 ? ivec2(i, here.y) : ivec2(here.x, i);
    float weight = bspline_weight((float(i + start) + 0.5) / texel_px - middle) / texel_px;
    vec4 light = texelFetch(source, texel, 0);
    light.rgb = usable(light.rgb);
    if (axis.x != 0) light.a = has_emission ? dot(usable(texelFetch(emission, texel, 0).rgb), vec3(1.0)) : 0.0;
    sum += weight * light;
  }
  result = sum;
}
