// Depths of the object seen from a light sample, over its bounding sphere (unshadowed_share() in lights.glsl).
#version 450 core
#include "interface.h"

layout(location = ATTRIBUTE_POSITION) in vec3 position_m;
uniform int light_sample;

void main() {
  vec3 to_light = light_samples.to_light[light_sample].xyz, right = light_samples.right[light_sample].xyz;
  vec3 p = (position_m - light_samples.sphere.xyz) / light_samples.sphere.w;
  gl_Position = vec4(dot(p, right), dot(p, cross(to_light, right)), 0.5 - 0.5 * dot(p, to_light), 1.0);
}
