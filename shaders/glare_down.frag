// Halves the resolution by 13 bilinear reads (Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare", 2014).
#version 450 core
#include "interface.h"

layout(binding = TEXTURE_SOURCE) uniform sampler2D source;
layout(location = 0) out vec4 result;

vec3 at(vec2 offset) { return texture(source, (2.0 * gl_FragCoord.xy + offset) / vec2(textureSize(source, 0))).rgb; }

void main() {
  vec3 inner = at(vec2(-1, -1)) + at(vec2(1, -1)) + at(vec2(-1, 1)) + at(vec2(1, 1));
  vec3 corners = at(vec2(-2, -2)) + at(vec2(2, -2)) + at(vec2(-2, 2)) + at(vec2(2, 2));
  vec3 edges = at(vec2(0, -2)) + at(vec2(-2, 0)) + at(vec2(2, 0)) + at(vec2(0, 2));
  result = vec4(0.125 * at(vec2(0)) + 0.125 * inner + 0.03125 * corners + 0.0625 * edges, 1.0);
}
