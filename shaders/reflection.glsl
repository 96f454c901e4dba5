// What a glossy surface mirrors: rays over the GGX lobe meet the object itself, the receiver or the probe.
#include "lights.glsl"
#include "rays.glsl"
#include "surroundings.glsl"

layout(binding = TEXTURE_BRDF) uniform sampler2D brdf_table;  // scale and bias of F0 by (n.v, roughness)
layout(std430, binding = BINDING_EXIT_RADIANCE) readonly buffer ExitRadianceBlock { float exit_radiance_floats[]; };
layout(std430, binding = BINDING_DIRECT_LIGHT) readonly buffer DirectLightBlock { float direct_light_floats[]; };
layout(std430, binding = BINDING_MATERIALS) readonly buffer MaterialBlock { SurfaceMaterial materials[]; };

// Smoother surfaces show the shapes of the lights: those look the whole probe up.
const float kMinHighlightRoughness = 0.1;

bool shows_lights_as_highlights(float roughness) {
  return light_samples.count.x > 0 && roughness >= kMinHighlightRoughness;
}

vec3 diffuse_albedo(SurfaceMaterial m, vec3 color) { return m.base_color_metallic.rgb * color * (1.0 - m.base_color_metallic.a); }

vec3 mirror_f0(SurfaceMaterial m, vec3 color) {
  return mix(vec3(m.dielectric.x), m.base_color_metallic.rgb * color, m.base_color_metallic.a);
}

// Radiance of the surface's own; what is unlit has the radiance that the exposure brings to its colour.
vec3 emitted_radiance(SurfaceMaterial m, vec3 color) {
  return m.emissive_roughness.rgb + m.unlit_color.rgb * color / max(view.exposure.rgb, vec3(1e-20));
}

float mirror_f90(SurfaceMaterial m) { return mix(m.dielectric.y, 1.0, m.base_color_metallic.a); }

// What a rough surface reflects after more than one meeting with its microfacets, as a factor on what it does after one: a metal that
// absorbs nothing sends everything back (Turquin, "Practical multiple scattering compensation for microfacet models", 2019).
vec3 multiple_scattering(vec3 f0, float n_v, float roughness) {
  vec2 table = texture(brdf_table, vec2(clamp(n_v, 0.0, 1.0), roughness)).rg;
  return 1.0 + f0 * (1.0 / (table.x + table.y) - 1.0);
}

// Split-sum factor of what is mirrored, and the share of light that enters a dielectric.
vec4 mirror_factor(SurfaceMaterial m, vec3 color, float n_v) {
  vec2 table = texture(brdf_table, vec2(clamp(n_v, 0.0, 1.0), m.emissive_roughness.a)).rg;
  vec3 f0 = mirror_f0(m, color);
  vec3 once = f0 * table.x + mirror_f90(m) * table.y;
  return vec4(once * multiple_scattering(f0, n_v, m.emissive_roughness.a), 1.0 - (m.dielectric.x * table.x + m.dielectric.y * table.y));
}

vec3 exit_radiance_of(uint vertex, vec3 albedo) {
  uint at = 3u * vertex;
  vec3 diffuse = vec3(exit_radiance_floats[at], exit_radiance_floats[at + 1u], exit_radiance_floats[at + 2u]);
  if (light_samples.count.x == 0) return diffuse;
  return diffuse + albedo * vec3(direct_light_floats[at], direct_light_floats[at + 1u], direct_light_floats[at + 2u]);
}

// Light that the object sends towards -direction from where a ray met it; its own mirror image is not traced further.
vec3 object_radiance(RayHit hit, vec3 origin, vec3 direction, float spread, float share) {
  vec3 w = vec3(1.0 - hit.weights.x - hit.weights.y, hit.weights);
  uvec4 t = hit.triangle;
  SurfaceMaterial m = materials[t.w];
  vec3 n = normalize(w.x * vertex_vec3(t.x, 1u) + w.y * vertex_vec3(t.y, 1u) + w.z * vertex_vec3(t.z, 1u));
  vec3 color = w.x * vertex_vec3(t.x, 2u) + w.y * vertex_vec3(t.y, 2u) + w.z * vertex_vec3(t.z, 2u);
  vec3 albedo = diffuse_albedo(m, color);
  vec3 diffuse = w.x * exit_radiance_of(t.x, albedo) + w.y * exit_radiance_of(t.y, albedo) + w.z * exit_radiance_of(t.z, albedo);
  vec4 factor = mirror_factor(m, color, -dot(n, direction));
  float roughness = m.emissive_roughness.a;
  // The ray stands for a bundle, which the second surface spreads further.
  float both = sqrt(sqrt(pow(roughness, 4.0) + pow(share, 4.0)));
  vec3 mirrored = surroundings(origin + hit.distance_m * direction, reflect(direction, n), spread + roughness * roughness, both, true);
  return diffuse * factor.a + mirrored * factor.rgb + emitted_radiance(m, color);
}

vec3 radiance_along(vec3 origin, vec3 direction, float spread, float roughness, bool with_lights) {
  RayHit nearest = RayHit(uvec4(0u), 1e30, vec2(0.0));
  if (view.options.x > 0) trace(origin, direction, view.probe_in_tag_m.w, nearest);
  if (nearest.distance_m < 1e30) return object_radiance(nearest, origin, direction, spread, roughness);
  return surroundings(origin, direction, spread, roughness, with_lights);
}

// Points whose mean is (0.5, 0.5) for any power of two.
vec2 hammersley(int i, int count) {
  float inverse_bits = float(bitfieldReverse(uint(i))) * 2.3283064365386963e-10;
  return vec2((float(i) + 0.5) / float(count), inverse_bits + 0.5 / float(count));
}

// Visible normal of the GGX distribution (Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 2018). `v` in the surface's
// frame, z along its normal.
vec3 visible_normal(vec3 v, float alpha, vec2 u) {
  vec3 stretched = normalize(vec3(alpha * v.xy, v.z));
  float length_squared = dot(stretched.xy, stretched.xy);
  vec3 t1 = length_squared > 0.0 ? vec3(-stretched.y, stretched.x, 0.0) * inversesqrt(length_squared) : vec3(1.0, 0.0, 0.0);
  vec3 t2 = cross(stretched, t1);
  float r = sqrt(u.x), phi = 2.0 * kPi * u.y, s = 0.5 * (1.0 + stretched.z);
  float p1 = r * cos(phi), p2 = mix(sqrt(1.0 - p1 * p1), r * sin(phi), s);
  vec3 n = p1 * t1 + p2 * t2 + sqrt(max(0.0, 1.0 - p1 * p1 - p2 * p2)) * stretched;
  return normalize(vec3(alpha * n.xy, max(0.0, n.z)));
}

mat3 frame_around(vec3 n) {
  vec3 helper = abs(n.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0);
  vec3 x = normalize(cross(helper, n));
  return mat3(x, cross(n, x), n);
}

// Mean radiance over the lobe around the mirror direction. Each ray stands for its share of the lobe: the probe is read at the
// roughness of that share, without the lights where those are added as highlights.
vec3 mirrored_radiance(vec3 position, vec3 n, vec3 to_viewer, float roughness, bool with_lights) {
  vec3 mirror = reflect(-to_viewer, n);
  vec3 dx = dFdx(mirror), dy = dFdy(mirror);
  int rays = roughness < kMinHighlightRoughness ? 4 : max(view.options.x, 1);
  // Without rays of its own the whole lobe is read from the prefiltered probe, in the mirror direction.
  bool traced = view.options.x > 0;
  float share = traced ? pow(float(rays), -0.25) * roughness : roughness, alpha = traced ? roughness * roughness : 0.0;
  float spread = share * share + 0.25 * length(dx + dy);
  mat3 surface_frame = frame_around(n);
  vec3 viewer = to_viewer * surface_frame, sum = vec3(0.0);
  vec3 origin = position + n * (0.05 * view.probe_in_tag_m.w);
  float weights = 0.0;
  for (int i = 0; i < rays; ++i) {
    vec2 u = hammersley(i, rays);
    vec3 direction = reflect(-to_viewer, surface_frame * visible_normal(viewer, alpha, u)) + (u.x - 0.5) * dx + (u.y - 0.5) * dy;
    float above = dot(direction, n);
    if (above <= 0.0) continue;
    // Smith's shadowing of the ray given the view, G2 / G1 (Heitz 2014), up to terms common to all rays.
    float weight = 2.0 * above / (above + sqrt(alpha * alpha + (1.0 - alpha * alpha) * above * above));
    sum += weight * radiance_along(origin, normalize(direction), spread, share, with_lights);
    weights += weight;
  }
  return weights > 0.0 ? sum / weights : probe_radiance(mirror, roughness, with_lights);
}
