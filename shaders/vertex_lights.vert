// What vertex gl_VertexID sees of the lights: VertexLights. Captured into a buffer; nothing is drawn.
#version 450 core
#include "interface.h"
#include "lights.glsl"
#include "vertices.glsl"

out vec4 irradiance_over_pi;
flat out uvec4 lit, dark;

void main() {
  VertexLights seen = lights_at(vertex_vec3(gl_VertexID, 0u), unit(vertex_vec3(gl_VertexID, 1u)));
  irradiance_over_pi = seen.irradiance_over_pi;
  lit = seen.lit, dark = seen.dark;
  gl_Position = vec4(0.0);
}
