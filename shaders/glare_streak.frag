// One pass of a streak (Kawase, GDC 2003): four samples b apart, weighted a^(b s). Passes with b = 1, 4, 16 ... compose exactly into a^k.
#version 450 core
#include "interface.h"

layout(binding = TEXTURE_SOURCE) uniform sampler2D source;
layout(location = 0) uniform vec2 step_texels;  // along the streak, b texels long
layout(location = 1) uniform vec4 weights;
layout(location = 0) out vec4 result;

void main() {
  vec3 sum = vec3(0.0);
  for (int s = 0; s < 4; ++s) {
    sum += weights[s] * texture(source, (gl_FragCoord.xy - float(s) * step_texels) / vec2(textureSize(source, 0))).rgb;
  }
  result = vec4(sum, 1.0);
}
