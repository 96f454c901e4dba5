// Irradiance / pi of the lights at vertex gl_VertexID, for what is seen in reflections. Captured into a buffer; nothing is drawn.
#version 450 core
#include "interface.h"
#include "lights.glsl"

layout(std430, binding = BINDING_VERTICES) readonly buffer VertexBlock { float vertex_floats[]; };  // position, normal, colour

out vec3 direct_light;

void main() {
  int at = 9 * gl_VertexID;
  vec3 position = vec3(vertex_floats[at], vertex_floats[at + 1], vertex_floats[at + 2]);
  vec3 normal = vec3(vertex_floats[at + 3], vertex_floats[at + 4], vertex_floats[at + 5]);
  direct_light = direct_irradiance_over_pi(position, normal / max(length(normal), 1e-20));
  gl_Position = vec4(0.0);
}
