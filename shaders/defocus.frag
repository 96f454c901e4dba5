// Defocus: one axis of a separable Gaussian.
#version 450 core
#include "interface.h"

layout(binding = TEXTURE_SOURCE) uniform sampler2D sharp;
uniform ivec2 step_px;
uniform ivec2 size;                  // size of what the texture holds
uniform int count;
uniform float weights[DEFOCUS_TAPS]; // weights of the middle and of each side

layout(location = 0) out vec4 blurred;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  blurred = weights[0] * texelFetch(sharp, pixel, 0);
  for (int i = 1; i < count; ++i) {
    ivec2 after = min(pixel + i * step_px, size - 1), before = max(pixel - i * step_px, ivec2(0));
    blurred += weights[i] * (texelFetch(sharp, after, 0) + texelFetch(sharp, before, 0));
  }
}
