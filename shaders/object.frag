// Diffuse light by the transfer, and what the surface mirrors: split-sum (Karis 2013), GGX, Schlick's Fresnel.
#version 450 core
#include "interface.h"
#include "distortion.glsl"
#include "receiver.glsl"
#include "reflection.glsl"

in Surface {
  vec3 position_tag_m;
  vec3 normal_tag;
  vec3 color;
  vec3 irradiance_over_pi;
  float mirrors_object;  // 0: nothing of the object lies above any corner
} surface;
uniform int material_index;
uniform int first_triangle;  // that gl_PrimitiveID counts from
layout(std430, binding = BINDING_TRIANGLE_LIGHTS) readonly buffer TriangleLightsBlock { TriangleLights triangle_lights[]; };

// Exposed linear in the plate's primaries.
layout(location = 0) out vec4 object_color;
layout(location = 1) out vec4 reflection_color;
layout(location = 2) out vec4 normal_depth;  // camera frame; metres along z
layout(location = 3) out vec4 emission_color;

vec3 shading_normal(vec3 to_viewer) {
  vec3 n = surface.normal_tag / max(length(surface.normal_tag), 1e-20);
  if (!gl_FrontFacing) n = -n;
  // An interpolated normal may look away from the viewer at the silhouette: bend it back to grazing.
  float n_v = dot(n, to_viewer);
  return n_v >= 0.0 ? n : normalize(n - n_v * to_viewer);
}

// What the pixel's triangle sees of the lights. What is kept is of the front, and of as many triangles as fit into a buffer.
TriangleLights lights_of_triangle() {
  int triangle = first_triangle + gl_PrimitiveID, count = light_samples.count.x;
  if (gl_FrontFacing && triangle < triangle_lights.length()) return triangle_lights[triangle];
  TriangleLights unknown = TriangleLights(vec4(0.0), vec4(0.0), vec4(0.0), uvec4(0u), uvec4(0u));
  for (int i = 0; i < count; ++i) unknown.mixed[i >> 5] |= 1u << (i & 31);
  return unknown;
}

// The number of the lowest bit, which is cleared.
int take_first(inout uvec4 bits) {
  int word = bits.x != 0u ? 0 : bits.y != 0u ? 1 : bits.z != 0u ? 2 : 3, bit = findLSB(bits[word]);
  bits[word] &= bits[word] - 1u;
  return 32 * word + bit;
}

struct Gloss {
  vec3 n, to_viewer, f0;
  float f90, alpha;
};

// What of the light that arrives from sample i is mirrored.
vec3 highlight(int i, vec3 arriving, Gloss g) {
  vec4 to_light = light_samples.to_light[i];
  if (!(dot(arriving, vec3(1.0)) > 0.0 && light_samples.irradiance[i].w > 0.0)) return vec3(0.0);
  return arriving * glossy_brdf(g.n, g.to_viewer, to_light.xyz, to_light.w, g.alpha, g.f0, g.f90);
}

vec3 exposed(vec3 radiance) {
  vec3 light = view.exposure.rgb * (mat3(view.plate_from_rec709) * radiance);
  // Never NaN, infinite or negative (out of the plate's gamut): one such pixel would spread with the glare.
  return mix(vec3(0.0), min(light, vec3(1e9)), greaterThan(light, vec3(0.0)));
}

void main() {
  SurfaceMaterial m = materials[material_index];
  vec3 to_viewer = normalize(view.camera_in_tag_m.xyz - surface.position_tag_m);
  vec3 n = shading_normal(to_viewer);
  vec2 table = brdf_at(dot(n, to_viewer), m.emissive_roughness.a);
  vec4 factor = mirror_factor(m, surface.color, table);
  vec3 reflected = vec3(0.0);
  float roughness = m.emissive_roughness.a;
  bool mirrors = m.base_color_metallic.a > 0.0 || m.dielectric.x > 0.0;
  bool highlights = mirrors && shows_lights_as_highlights(roughness);
  bool may_meet = surface.mirrors_object != 0.0 || !gl_FrontFacing;
  if (mirrors) reflected = factor.rgb * mirrored_radiance(surface.position_tag_m, n, to_viewer, roughness, may_meet, !highlights);

  TriangleLights lights = lights_of_triangle();
  vec3 irradiance = max(n * mat3(lights.flux_red.xyz, lights.flux_green.xyz, lights.flux_blue.xyz), 0.0);
  vec3 f0 = mirror_f0(m, surface.color);
  Gloss gloss = Gloss(n, to_viewer, f0, mirror_f90(m), roughness * roughness);
  vec3 shine = vec3(0.0);
  // Bits are gone through by loops that end with them: one over all samples would take its time whatever it left out.
  for (uvec4 rest = lights.mixed; any(notEqual(rest, uvec4(0u)));) {
    int i = take_first(rest);
    vec3 arriving = irradiance_from(i, surface.position_tag_m, n);
    irradiance += arriving;
    if (highlights) shine += highlight(i, arriving, gloss);
  }
  for (uvec4 rest = highlights ? lights.shining : uvec4(0u); any(notEqual(rest, uvec4(0u)));) {
    int i = take_first(rest);
    shine += highlight(i, dot(n, light_samples.to_light[i].xyz) * light_samples.irradiance[i].rgb, gloss);
  }
  reflected += shine * multiple_scattering(f0, table);
  vec3 diffuse = (surface.irradiance_over_pi + irradiance / kPi) * diffuse_albedo(m, surface.color);

  // What the dielectric boundary mirrors does not reach the pigment below it.
  vec3 emitted = emitted_radiance(m, surface.color, view.exposure.rgb);
  vec3 radiance = diffuse * factor.a + reflected + emitted;

  object_color = vec4(exposed(radiance), 1.0);
  reflection_color = vec4(exposed(reflected), 1.0);
  emission_color = vec4(exposed(emitted), 1.0);
  normal_depth = vec4(mat3(view.camera_from_tag) * n, (view.camera_from_tag * vec4(surface.position_tag_m, 1.0)).z);
}
