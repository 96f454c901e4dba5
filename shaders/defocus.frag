// Defocus: one axis of a separable Gaussian, of object and shadow together.
#version 450 core
#include "interface.h"

layout(binding = TEXTURE_OBJECT) uniform sampler2D object;  // premultiplied exposed linear
layout(binding = TEXTURE_SHADOW) uniform sampler2D shadow;  // ratio
uniform ivec2 step_px;
uniform ivec2 size;                                         // size of what the textures hold
uniform int count;
uniform float weights[DEFOCUS_TAPS];                        // weights of the middle and of each side

layout(location = 0) out vec4 object_blurred;
layout(location = 1) out vec4 shadow_blurred;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  object_blurred = weights[0] * texelFetch(object, pixel, 0);
  shadow_blurred = weights[0] * texelFetch(shadow, pixel, 0);
  for (int i = 1; i < count; ++i) {
    ivec2 after = min(pixel + i * step_px, size - 1), before = max(pixel - i * step_px, ivec2(0));
    object_blurred += weights[i] * (texelFetch(object, after, 0) + texelFetch(object, before, 0));
    shadow_blurred += weights[i] * (texelFetch(shadow, after, 0) + texelFetch(shadow, before, 0));
  }
}
