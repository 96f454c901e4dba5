// Three sizes laid over each other, the smaller ones bilinearly.
#version 450 core
#include "interface.h"

layout(binding = TEXTURE_SOURCE) uniform sampler2D fine;
layout(binding = TEXTURE_BLOOM) uniform sampler2D middle;
layout(binding = TEXTURE_STREAKS) uniform sampler2D coarse;
layout(location = 0) out vec4 result;

void main() {
  vec2 at = gl_FragCoord.xy / vec2(textureSize(fine, 0));
  result = vec4(texture(fine, at).rgb + texture(middle, at).rgb + texture(coarse, at).rgb, 1.0);
}
