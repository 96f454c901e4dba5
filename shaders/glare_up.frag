// The coarser level at this one's resolution; blending adds it to what this one has.
#version 450 core
#include "interface.h"
#include "bspline.glsl"

layout(binding = TEXTURE_COARSER) uniform sampler2D coarser;
layout(location = 0) out vec4 result;

void main() { result = vec4(bspline(coarser, 0.5 * (gl_FragCoord.xy + GLARE_MARGIN)), 1.0); }
