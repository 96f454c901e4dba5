// One pass of a streak (Kawase, GDC 2003): four samples b texels apart along a diagonal, weighted a^(b s). Three passes, b = 1, 4, 16, make a^k.
#version 450 core
#include "interface.h"

layout(binding = TEXTURE_SOURCE) uniform sampler2D source;
uniform ivec2 step_texels;
uniform vec2 weight;  // a^b, scale of the sum
layout(location = 0) out vec4 result;

void main() {
  vec2 one_over_size = 1.0 / vec2(textureSize(source, 0));
  vec3 sum = vec3(0.0);
  float share = weight.y;
  for (int s = 0; s < 4; ++s) {
    sum += share * texture(source, (gl_FragCoord.xy - vec2(s * step_texels)) * one_over_size).rgb;
    share *= weight.x;
  }
  result = vec4(sum, 1.0);
}
