// The coarser level through a 3 x 3 tent; blending mixes it into this one, so the weights of all levels sum to 1.
#version 450 core
#include "interface.h"

layout(binding = TEXTURE_COARSER) uniform sampler2D coarser;
layout(location = 0) out vec4 result;

vec3 at(float x, float y) { return texture(coarser, (0.5 * gl_FragCoord.xy + vec2(x, y)) / vec2(textureSize(coarser, 0))).rgb; }

void main() {
  vec3 corners = at(-1, -1) + at(1, -1) + at(-1, 1) + at(1, 1);
  vec3 edges = at(0, -1) + at(-1, 0) + at(1, 0) + at(0, 1);
  result = vec4(0.25 * at(0, 0) + 0.125 * edges + 0.0625 * corners, 1.0);
}
