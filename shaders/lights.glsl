// The lights split off the probe: samples that count as one direction each, with a map of the depths at which they first meet the object.
layout(binding = TEXTURE_SHADOW_MAPS) uniform sampler2DArrayShadow shadow_maps;  // linear filter; a layer a sample

const float kPi = 3.14159265;

// Share of sample i's light that the object lets through to `position`: from 0 to 1 along the border of a texel.
float unshadowed_share(int i, vec3 position) {
  vec3 to_light = light_samples.to_light[i].xyz, right = light_samples.right[i].xyz;
  vec3 p = (position - light_samples.sphere.xyz) / light_samples.sphere.w;
  vec2 across = vec2(dot(p, right), dot(p, cross(to_light, right)));
  if (any(greaterThan(abs(across), vec2(1.0)))) return 1.0;
  float depth = clamp(0.5 - 0.5 * dot(p, to_light), 0.0, 1.0);
  return texture(shadow_maps, vec4(0.5 * across + 0.5, float(i), depth));
}

// Irradiance from sample i. Starts a texel and a half above the surface, which is not known any finer in the map.
vec3 irradiance_from(int i, vec3 position, vec3 n) {
  float n_l = dot(n, light_samples.to_light[i].xyz);
  if (n_l <= 0.0) return vec3(0.0);
  return n_l * unshadowed_share(i, position + light_samples.lift_m.x * n) * light_samples.irradiance[i].rgb;
}

vec3 direct_irradiance_over_pi(vec3 position, vec3 n) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < light_samples.count.x; ++i) sum += irradiance_from(i, position, n);
  return sum / kPi;
}

// GGX with height-correlated Smith and Schlick's Fresnel, for light from a patch of the sky `spread` (root mean square radians along one
// axis) wide. Half of its spread adds to the microfacets' slopes; alpha^2 + spread^2 is what lowers their distribution's peak, which has
// no variance to be added to, by as much.
vec3 glossy_brdf(vec3 n, vec3 to_viewer, vec3 to_light, float spread, float alpha, vec3 f0, float f90) {
  vec3 h = normalize(to_viewer + to_light);
  float n_h = max(dot(n, h), 0.0), n_v = max(dot(n, to_viewer), 1e-4), n_l = dot(n, to_light);
  float a2 = alpha * alpha, wide2 = min(a2 + spread * spread, 1.0);
  float d = n_h * n_h * (wide2 - 1.0) + 1.0;
  float shadowing = n_l * sqrt(n_v * n_v * (1.0 - a2) + a2) + n_v * sqrt(n_l * n_l * (1.0 - a2) + a2);
  vec3 fresnel = f0 + (f90 - f0) * pow(1.0 - max(dot(to_viewer, h), 0.0), 5.0);
  return fresnel * (wide2 / (kPi * d * d) * 0.5 / shadowing);
}
