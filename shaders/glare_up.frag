// The coarser level at this one's resolution. OWN: bilinear, and with this level's own part; else smooth, to the grid.
#version 450 core
#include "interface.h"
#include "bspline.glsl"

layout(binding = TEXTURE_SOURCE) uniform sampler2D own;
layout(binding = TEXTURE_COARSER) uniform sampler2D coarser;
uniform float own_gain;
uniform float coarser_gain;
layout(location = 0) out vec4 result;

void main() {
  vec2 texel = 0.5 * (gl_FragCoord.xy + GLARE_MARGIN);
#ifdef OWN
  vec3 light = coarser_gain * texture(coarser, texel / vec2(textureSize(coarser, 0))).rgb;
  result = vec4(light + own_gain * texelFetch(own, ivec2(gl_FragCoord.xy), 0).rgb, 1.0);
#else
  result = vec4(bspline(coarser, texel), 1.0);
#endif
}
