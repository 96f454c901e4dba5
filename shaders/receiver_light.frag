// Irradiance / pi of the lights on the receiving plane, a texel a place.
#version 450 core
#include "interface.h"
#include "lights.glsl"

layout(location = 0) out vec4 irradiance_over_pi;

void main() {
  vec2 place = mix(receiver.lights_min_max_m.xy, receiver.lights_min_max_m.zw, gl_FragCoord.xy / receiver.light_texels.xy);
  irradiance_over_pi = lights_at(vec3(place, 0.0), vec3(0.0, 0.0, 1.0)).irradiance_over_pi;
}
