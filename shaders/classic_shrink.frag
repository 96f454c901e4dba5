// Half the size: the mean of 2 x 2 texels.
#version 450 core
#include "interface.h"

layout(binding = TEXTURE_SOURCE) uniform sampler2D source;
layout(location = 0) out vec4 result;

void main() {
  ivec2 first = 2 * ivec2(gl_FragCoord.xy);
  result = 0.25 * (texelFetch(source, first, 0) + texelFetch(source, first + ivec2(1, 0), 0) +
                   texelFetch(source, first + ivec2(0, 1), 0) + texelFetch(source, first + ivec2(1, 1), 0));
}
