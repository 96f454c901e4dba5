// What is over the threshold, averaged over each texel's part of the picture: every pixel counts by how much of it lies there, so
// that none is missed and a moving highlight does not flicker.
#version 450 core
#include "interface.h"

layout(binding = TEXTURE_SOURCE) uniform sampler2D scene;  // linear, the picture in its first texels
uniform ivec2 size;                                        // size of the picture
uniform float threshold;                                   // luminance

layout(location = 0) out vec4 bright;

const float kTargetSize = 512.0, kMaxLight = 1e9;

vec3 excess(ivec2 pixel) {
  vec3 v = texelFetch(scene, pixel, 0).rgb;
  v = clamp(mix(v, vec3(0.0), isnan(v)), 0.0, kMaxLight);
  float luminance = dot(v, vec3(0.2126, 0.7152, 0.0722));
  return luminance > threshold ? v * ((luminance - threshold) / luminance) : vec3(0.0);
}

void main() {
  vec2 scale = vec2(size) / kTargetSize;
  vec2 first = floor(gl_FragCoord.xy) * scale, last = first + scale;
  vec3 sum = vec3(0.0);
  for (int y = int(first.y); y < size.y && float(y) < last.y; ++y) {
    float rows = min(float(y) + 1.0, last.y) - max(float(y), first.y);
    for (int x = int(first.x); x < size.x && float(x) < last.x; ++x) {
      float columns = min(float(x) + 1.0, last.x) - max(float(x), first.x);
      sum += rows * columns * excess(ivec2(x, y));
    }
  }
  bright = vec4(sum / (scale.x * scale.y), 1.0);
}
