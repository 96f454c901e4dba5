// The lights split off the probe: samples that count as one direction each, with a map of the depths at which they first meet the object.
#include "shading.h"

layout(binding = TEXTURE_SHADOW_MAPS) uniform sampler2DArrayShadow shadow_maps;  // linear filter; a layer a sample

// Share of sample i's light that the object lets through to `position`: from 0 to 1 along the border of a texel.
float unshadowed_share(int i, vec3 position) {
  vec3 to_light = light_samples.to_light[i].xyz, right = light_samples.right[i].xyz;
  vec3 p = (position - light_samples.sphere.xyz) / light_samples.sphere.w;
  vec2 across = vec2(dot(p, right), dot(p, cross(to_light, right)));
  if (any(greaterThan(abs(across), vec2(1.0)))) return 1.0;
  float depth = clamp(0.5 - 0.5 * dot(p, to_light), 0.0, 1.0);
  return texture(shadow_maps, vec4(0.5 * across + 0.5, float(i), depth));
}

// Share of sample i that a surface sees. Starts a texel and a half above the surface, which is not known any finer in the map.
float seen_share(int i, vec3 position, vec3 n) {
  return dot(n, light_samples.to_light[i].xyz) > 0.0 ? unshadowed_share(i, position + light_samples.lift_m.x * n) : 0.0;
}

vec3 irradiance_from(int i, vec3 position, vec3 n) {
  return seen_share(i, position, n) * dot(n, light_samples.to_light[i].xyz) * light_samples.irradiance[i].rgb;
}

// What a place sees of all samples.
VertexLights lights_at(vec3 position, vec3 n) {
  VertexLights lights = VertexLights(vec4(0.0), uvec4(0u), uvec4(0u));
  for (int i = 0; i < light_samples.count.x; ++i) {
    float share = seen_share(i, position, n), n_l = dot(n, light_samples.to_light[i].xyz);
    uint bit = 1u << (i & 31);
    if (share > 0.999) lights.lit[i >> 5] |= bit;
    if (share < 0.001) lights.dark[i >> 5] |= bit;
    lights.irradiance_over_pi.rgb += share * n_l / kPi * light_samples.irradiance[i].rgb;
  }
  return lights;
}
