// The pure mathematics of surfaces, compiled as GLSL and as C++: what both renderers must agree on stands here once. GLSL's subset
// without swizzles, with f after each number.
#ifdef __cplusplus
#pragma once
#include <glm/glm.hpp>
#include <glm/integer.hpp>

#include "shaders/interface.h"

namespace catchlight::render::shading {
using namespace glm;
using shader_interface::SurfaceMaterial;
#define PURE inline
#else
#define PURE
#endif

const float kPi = 3.14159265f;

// Smoother surfaces show the shapes of the lights: those look the whole probe up.
const float kMinHighlightRoughness = 0.1f;

PURE vec3 diffuse_albedo(SurfaceMaterial m, vec3 color) {
  return vec3(m.base_color_metallic) * color * (1.0f - m.base_color_metallic.w);
}

PURE vec3 mirror_f0(SurfaceMaterial m, vec3 color) {
  return mix(vec3(m.dielectric.x), vec3(m.base_color_metallic) * color, m.base_color_metallic.w);
}

PURE float mirror_f90(SurfaceMaterial m) { return mix(m.dielectric.y, 1.0f, m.base_color_metallic.w); }

// What a rough surface reflects after more than one meeting with its microfacets, as a factor on what it does after one: a metal that
// absorbs nothing sends everything back (Turquin, "Practical multiple scattering compensation for microfacet models", 2019).
// `table`: scale and bias of F0 by (n.v, roughness).
PURE vec3 multiple_scattering(vec3 f0, vec2 table) { return 1.0f + f0 * (1.0f / (table.x + table.y) - 1.0f); }

// Split-sum factor of what is mirrored, and the share of light that enters a dielectric.
PURE vec4 mirror_factor(SurfaceMaterial m, vec3 color, vec2 table) {
  vec3 f0 = mirror_f0(m, color);
  vec3 once = f0 * table.x + mirror_f90(m) * table.y;
  return vec4(once * multiple_scattering(f0, table), 1.0f - (m.dielectric.x * table.x + m.dielectric.y * table.y));
}

// Radiance of the surface's own; what is unlit has the radiance that the exposure brings to its colour.
PURE vec3 emitted_radiance(SurfaceMaterial m, vec3 color, vec3 exposure) {
  return vec3(m.emissive_roughness) + vec3(m.unlit_color) * color / max(exposure, vec3(1e-20f));
}

// GGX with height-correlated Smith and Schlick's Fresnel, for light from a patch of the sky `spread` (root mean square radians along one
// axis) wide. Half of its spread adds to the microfacets' slopes; alpha^2 + spread^2 is what lowers their distribution's peak, which has
// no variance to be added to, by as much.
PURE vec3 glossy_brdf(vec3 n, vec3 to_viewer, vec3 to_light, float spread, float alpha, vec3 f0, float f90) {
  vec3 h = normalize(to_viewer + to_light);
  float n_h = max(dot(n, h), 0.0f), n_v = max(dot(n, to_viewer), 1e-4f), n_l = dot(n, to_light);
  float a2 = alpha * alpha, wide2 = min(a2 + spread * spread, 1.0f);
  float d = n_h * n_h * (wide2 - 1.0f) + 1.0f;
  float shadowing = n_l * sqrt(n_v * n_v * (1.0f - a2) + a2) + n_v * sqrt(n_l * n_l * (1.0f - a2) + a2);
  vec3 fresnel = f0 + (f90 - f0) * pow(1.0f - max(dot(to_viewer, h), 0.0f), 5.0f);
  return fresnel * (wide2 / (kPi * d * d) * 0.5f / shadowing);
}

// Levels of a reflection map are even steps of roughness from a perfect mirror on. Before the first, mixing gives the lobe's
// variance, roughness^4: a mix in proportion to roughness would put a halo around what a polished surface mirrors.
PURE float level_of(float roughness, int levels) {
  float level = roughness * float(levels - 1);
  return level < 1.0f ? level * level * level * level : level;
}

// Points whose mean is (0.5, 0.5) for any power of two.
PURE vec2 hammersley(int i, int count) {
  float inverse_bits = float(bitfieldReverse(uint(i))) * 2.3283064365386963e-10f;
  return vec2((float(i) + 0.5f) / float(count), inverse_bits + 0.5f / float(count));
}

// A point of the unit disc, evenly spread by u of the unit square.
PURE vec2 disc_point(vec2 u) {
  float r = sqrt(u.x), phi = 2.0f * kPi * u.y;
  return r * vec2(cos(phi), sin(phi));
}

// Visible normal of the GGX distribution (Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 2018). `v` in the surface's
// frame, z along its normal.
PURE vec3 visible_normal(vec3 v, float alpha, vec2 disc) {
  vec3 stretched = normalize(vec3(alpha * v.x, alpha * v.y, v.z));
  float length_squared = stretched.x * stretched.x + stretched.y * stretched.y;
  vec3 t1 = length_squared > 0.0f ? vec3(-stretched.y, stretched.x, 0.0f) * inversesqrt(length_squared) : vec3(1.0f, 0.0f, 0.0f);
  vec3 t2 = cross(stretched, t1);
  float s = 0.5f * (1.0f + stretched.z);
  float p1 = disc.x, p2 = mix(sqrt(1.0f - p1 * p1), disc.y, s);
  vec3 n = p1 * t1 + p2 * t2 + sqrt(max(0.0f, 1.0f - p1 * p1 - p2 * p2)) * stretched;
  return normalize(vec3(alpha * n.x, alpha * n.y, max(0.0f, n.z)));
}

// Smith's shadowing of a ray given the view, G2 / G1 (Heitz 2014), up to terms common to all rays. `above`: n.l.
PURE float lobe_weight(float above, float alpha) {
  return 2.0f * above / (above + sqrt(alpha * alpha + (1.0f - alpha * alpha) * above * above));
}

PURE mat3 frame_around(vec3 n) {
  vec3 helper = abs(n.z) < 0.9f ? vec3(0.0f, 0.0f, 1.0f) : vec3(1.0f, 0.0f, 0.0f);
  vec3 x = normalize(cross(helper, n));
  return mat3(x, cross(n, x), n);
}

// Variances of lobes add, and a lobe's is roughness^4.
PURE float wider(float roughness, float by) {
  return sqrt(sqrt(roughness * roughness * roughness * roughness + by * by * by * by));
}

// Metal is followed to metal so often again; from there on the surroundings are all that is mirrored.
const int kMoreBounces = 2;
// A surface that mirrors less than this of the light is not followed to the next.
const float kMinFollowed = 0.1f;

// One ray stands for this share of the width of the lobe that it chose its way from: the ways of a whole lobe's rays fill it.
const float kFurtherShare = 0.75f;

// The choice among a surface's facets of a ray of number `index` in its lobe, where it goes on from the surface that it meets after
// `bounce` others. Evenly spread over the unit square (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences").
PURE vec2 way_from_surface(int index, int bounce) {
  vec2 along = vec2(0.7548776662f, 0.5698402910f), across = vec2(0.3819660113f, 0.6180339887f);
  return fract(0.5f + float(index + 1) * along + float(bounce) * across);
}

// Direction of a ray that arrives along `direction` at a rough surface and goes on by the choice `u` among its facets.
PURE vec3 mirrored_way(vec3 direction, vec3 n, float roughness, vec2 u) {
  mat3 surface_frame = frame_around(n);
  vec3 facet = surface_frame * visible_normal(-direction * surface_frame, roughness * roughness, disc_point(u));
  vec3 sampled = reflect(direction, facet);
  return dot(sampled, n) > 0.0f ? normalize(sampled) : reflect(direction, n);
}

#ifdef __cplusplus
#undef PURE
}  // namespace catchlight::render::shading
#endif
