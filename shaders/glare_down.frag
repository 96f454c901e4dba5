// Halves the resolution by (1 3 3 1) / 8 both ways, as four bilinear reads.
#version 450 core
#include "interface.h"

layout(binding = TEXTURE_SOURCE) uniform sampler2D source;
layout(location = 0) out vec4 result;

vec3 at(float x, float y) {
  vec2 texel = 2.0 * gl_FragCoord.xy - GLARE_MARGIN + vec2(x, y);
  return texture(source, texel / vec2(textureSize(source, 0))).rgb;
}

void main() { result = vec4(0.25 * (at(-0.75, -0.75) + at(0.75, -0.75) + at(-0.75, 0.75) + at(0.75, 0.75)), 1.0); }
