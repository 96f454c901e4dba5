// The plate as the light that it photographed: what a mirror on the receiver shows of it.
#version 450 core
#include "interface.h"
#include "color.glsl"

layout(binding = TEXTURE_PLATE) uniform sampler2D plate;  // codes
layout(location = 0) out vec4 radiance;                   // scene-linear, Rec. 709

void main() {
  vec3 light = linear_from_code(composite.modes.x, texelFetch(plate, ivec2(gl_FragCoord.xy), 0).rgb);
  vec3 rec709 = inverse(mat3(view.plate_from_rec709)) * max(light - composite.black.rgb, 0.0);
  vec3 unexposed = rec709 / view.exposure.rgb;
  // A channel without exposure, or a NaN in the plate, shows nothing. Half floats end at 65504.
  radiance = vec4(mix(vec3(0.0), min(unexposed, 6e4), greaterThan(unexposed, vec3(0.0))), 1.0);
}
