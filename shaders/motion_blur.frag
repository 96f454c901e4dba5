// Motion blur: a box along each pixel's own motion.
#version 450 core
#include "interface.h"

layout(binding = TEXTURE_SOURCE) uniform sampler2D sharp;
uniform ivec2 size;  // size of what the texture holds
// The motion at the first pixel while the shutter is open, and how it changes from pixel to pixel.
uniform vec2 motion_px;
uniform mat2 change;

layout(location = 0) out vec4 blurred;

const float kMaxMotion_px = 120.0;

vec4 fetch(ivec2 pixel) { return texelFetch(sharp, clamp(pixel, ivec2(0), size - 1), 0); }

// Steps of a pixel along the longer axis, with the weights (all alike but the two outermost) whose variance is the box's,
// length^2 / 12; linear between pixels across.
vec4 mean_along(ivec2 pixel, vec2 way_px) {
  bool steep = abs(way_px.y) > abs(way_px.x);
  float length_px = min(steep ? abs(way_px.y) : abs(way_px.x), kMaxMotion_px);
  int reach = int(ceil(0.5 * (sqrt(1.0 + length_px * length_px) - 1.0) - 1e-6));
  if (reach == 0) return fetch(pixel);
  float slope = steep ? way_px.x / way_px.y : way_px.y / way_px.x;
  float variance = length_px * length_px / 12.0, k = float(reach), inner = (k - 1.0) * k / 3.0;
  float ends = (variance - inner) / (k * k - inner), each = (1.0 - ends) / (2.0 * k - 1.0);
  vec4 sum = vec4(0.0);
  for (int i = -reach; i <= reach; ++i) {
    float across = float(i) * slope, low = floor(across), share = across - low;
    ivec2 first = steep ? ivec2(int(low), i) : ivec2(i, int(low)), next = steep ? ivec2(1, 0) : ivec2(0, 1);
    vec4 light = fetch(pixel + first);
    if (share > 0.0) light = mix(light, fetch(pixel + first + next), share);
    sum += (abs(i) == reach ? 0.5 * ends : each) * light;
  }
  return sum;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  blurred = mean_along(pixel, motion_px + change * vec2(pixel));
}
