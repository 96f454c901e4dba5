// What a glossy surface mirrors: rays over the GGX lobe meet the object itself, the receiver or the probe.
#include "lights.glsl"
#include "rays.glsl"
#include "surroundings.glsl"

layout(binding = TEXTURE_BRDF) uniform sampler2D brdf_table;  // scale and bias of F0 by (n.v, roughness)
layout(std430, binding = BINDING_IRRADIANCE) readonly buffer IrradianceBlock { float irradiance_floats[]; };
layout(std430, binding = BINDING_VERTEX_LIGHTS) readonly buffer VertexLightsBlock { VertexLights vertex_lights[]; };
layout(std430, binding = BINDING_MATERIALS) readonly buffer MaterialBlock { SurfaceMaterial materials[]; };

bool shows_lights_as_highlights(float roughness) {
  return light_samples.count.x > 0 && roughness >= kMinHighlightRoughness;
}

vec2 brdf_at(float n_v, float roughness) { return texture(brdf_table, vec2(clamp(n_v, 0.0, 1.0), roughness)).rg; }

vec3 irradiance_over_pi_of(uint vertex) {
  uint at = 3u * vertex;
  vec3 smooth_part = vec3(irradiance_floats[at], irradiance_floats[at + 1u], irradiance_floats[at + 2u]);
  if (light_samples.count.x == 0) return smooth_part;
  return smooth_part + vertex_lights[vertex].irradiance_over_pi.rgb;
}

struct SurfaceHit {
  vec3 normal;
  float roughness;
  vec3 sent;    // radiance towards where the ray came from, but for what is mirrored
  vec3 factor;  // of what is mirrored
  bool mirrors_on;
};

SurfaceHit surface_at(RayHit hit, vec3 direction) {
  vec3 w = vec3(1.0 - hit.weights.x - hit.weights.y, hit.weights);
  uvec4 t = hit.triangle;
  SurfaceMaterial m = materials[t.w];
  SurfaceHit surface;
  surface.normal = normalize(w.x * vertex_vec3(t.x, 1u) + w.y * vertex_vec3(t.y, 1u) + w.z * vertex_vec3(t.z, 1u));
  surface.roughness = m.emissive_roughness.a;
  vec3 color = w.x * vertex_vec3(t.x, 2u) + w.y * vertex_vec3(t.y, 2u) + w.z * vertex_vec3(t.z, 2u);
  vec3 albedo = diffuse_albedo(m, color);
  vec3 diffuse = albedo * (w.x * irradiance_over_pi_of(t.x) + w.y * irradiance_over_pi_of(t.y) + w.z * irradiance_over_pi_of(t.z));
  float n_v = -dot(surface.normal, direction);
  vec4 factor = mirror_factor(m, color, brdf_at(n_v, surface.roughness));
  surface.sent = diffuse * factor.a + emitted_radiance(m, color, view.exposure.rgb);
  surface.factor = factor.rgb;
  surface.mirrors_on = n_v > 0.0 && max(factor.r, max(factor.g, factor.b)) >= kMinFollowed;
  return surface;
}

vec3 ray_start(vec3 position, vec3 n) { return position + n * (0.05 * view.probe_in_tag_m.w); }

// Radiance that arrives at `origin` from `direction`. The ray stands for a bundle of half width `spread`, as wide as the lobe of a
// surface of `roughness`, which surfaces on its way spread further. `index`: its number in its lobe. `may_meet`: it may meet the object.
vec3 radiance_along(vec3 origin, vec3 direction, float spread, float roughness, int index, bool may_meet, bool with_lights) {
  vec3 sum = vec3(0.0), through = vec3(1.0);
  for (int bounce = 0; may_meet; ++bounce) {
    RayHit hit = RayHit(uvec4(0u), 1e30, vec2(0.0));
    trace(origin, direction, view.probe_in_tag_m.w, hit);
    if (hit.distance_m >= 1e30) break;
    SurfaceHit surface = surface_at(hit, direction);
    sum += through * surface.sent;
    through *= surface.factor;
    vec3 position = origin + hit.distance_m * direction;
    bool follows = bounce < kMoreBounces && surface.mirrors_on;
    float of_lobe = follows ? kFurtherShare * surface.roughness : surface.roughness;
    spread += of_lobe * of_lobe;
    roughness = wider(roughness, of_lobe);
    with_lights = true;
    origin = follows ? ray_start(position, surface.normal) : position;
    direction = follows ? mirrored_way(direction, surface.normal, surface.roughness, way_from_surface(index, bounce))
                        : reflect(direction, surface.normal);
    if (!follows) break;
  }
  return sum + through * surroundings(origin, direction, spread, roughness, with_lights);
}

// Mean radiance over the lobe around the mirror direction. Each ray stands for its share of the lobe: the probe is read at the
// roughness of that share, without the lights where those are added as highlights.
vec3 mirrored_radiance(vec3 position, vec3 n, vec3 to_viewer, float roughness, bool may_meet, bool with_lights) {
  vec3 mirror = reflect(-to_viewer, n);
  vec3 dx = dFdx(mirror), dy = dFdy(mirror);
  int rays = roughness < kMinHighlightRoughness ? 4 : max(view.options.x, 1);
  // Without rays of its own the whole lobe is read from the prefiltered probe, in the mirror direction.
  bool traced = view.options.x > 0;
  float share = traced ? pow(float(rays), -0.25) * roughness : roughness, alpha = traced ? roughness * roughness : 0.0;
  float spread = share * share + 0.25 * length(dx + dy);
  mat3 surface_frame = frame_around(n);
  vec3 viewer = to_viewer * surface_frame, sum = vec3(0.0);
  vec3 origin = ray_start(position, n);
  float weights = 0.0;
  for (int i = 0; i < rays; ++i) {
    vec2 u = hammersley(i, rays);
    vec3 direction = reflect(-to_viewer, surface_frame * visible_normal(viewer, alpha, disc_point(u))) + (u.x - 0.5) * dx + (u.y - 0.5) * dy;
    float above = dot(direction, n);
    if (above <= 0.0) continue;
    float weight = lobe_weight(above, alpha);
    sum += weight * radiance_along(origin, normalize(direction), spread, share, i, traced && may_meet, with_lights);
    weights += weight;
  }
  return weights > 0.0 ? sum / weights : probe_radiance(mirror, roughness, with_lights);
}
