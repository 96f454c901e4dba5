// What triangle gl_VertexID sees of the lights as a whole: TriangleLights. Captured into a buffer; nothing is drawn.
#version 450 core
#include "interface.h"
#include "lights.glsl"
#include "vertices.glsl"

layout(std430, binding = BINDING_VERTEX_LIGHTS) readonly buffer VertexLightsBlock { VertexLights vertex_lights[]; };
layout(std430, binding = BINDING_CORNERS) readonly buffer CornerBlock { uint corners[]; };

out vec4 flux_red, flux_green, flux_blue;
flat out uvec4 shining, mixed;

// In a triangle that is larger than that many steps, every sample is looked up at each pixel.
const int kMaxSteps = 8;

// Takes out the samples of which something else holds within the triangle than at its corners.
void look_between(uvec3 corner, inout uvec4 all_lit, inout uvec4 all_dark) {
  vec3 a = vertex_vec3(corner.x, 0u), b = vertex_vec3(corner.y, 0u), c = vertex_vec3(corner.z, 0u);
  float steps = ceil(max(distance(a, b), max(distance(b, c), distance(c, a))) / light_samples.lift_m.y);
  if (!(steps <= float(kMaxSteps))) all_lit = all_dark = uvec4(0u);
  if (steps <= 1.0) return;
  for (float up = 0.0; up <= min(steps, float(kMaxSteps)); ++up) {
    for (float across = 0.0; across + up <= steps; ++across) {
      vec3 w = vec3(steps - up - across, across, up) / steps;
      vec3 n = w.x * vertex_vec3(corner.x, 1u) + w.y * vertex_vec3(corner.y, 1u) + w.z * vertex_vec3(corner.z, 1u);
      VertexLights here = lights_at(w.x * a + w.y * b + w.z * c, unit(n));
      all_lit &= here.lit, all_dark &= here.dark;
    }
  }
}

void main() {
  uint first = 3u * uint(gl_VertexID);
  uvec3 corner = uvec3(corners[first], corners[first + 1u], corners[first + 2u]);
  VertexLights a = vertex_lights[corner.x], b = vertex_lights[corner.y], c = vertex_lights[corner.z];
  uvec4 lit = a.lit & b.lit & c.lit, dark = a.dark & b.dark & c.dark;
  look_between(corner, lit, dark);
  shining = mixed = uvec4(0u);
  mat3 flux = mat3(0.0);
  for (int i = 0; i < light_samples.count.x; ++i) {
    uint bit = 1u << (i & 31);
    bool is_lit = (lit[i >> 5] & bit) != 0u, is_dark = (dark[i >> 5] & bit) != 0u;
    if (is_lit) flux += outerProduct(light_samples.to_light[i].xyz, light_samples.irradiance[i].rgb);
    if (is_lit && light_samples.irradiance[i].w > 0.0) shining[i >> 5] |= bit;
    if (!is_lit && !is_dark) mixed[i >> 5] |= bit;
  }
  flux_red = vec4(flux[0], 0.0), flux_green = vec4(flux[1], 0.0), flux_blue = vec4(flux[2], 0.0);
  gl_Position = vec4(0.0);
}
