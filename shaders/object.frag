// Diffuse exit radiance from the transfer, and what the surface mirrors of the whole probe: split-sum (Karis 2013), GGX, Schlick's Fresnel.
#version 450 core
#include "interface.h"

layout(binding = TEXTURE_PROBE) uniform samplerCube probe;   // level by perceptual roughness
layout(binding = TEXTURE_BRDF) uniform sampler2D brdf_table;  // scale and bias of F0 by (n.v, roughness)

in Surface {
  vec3 position_tag_m;
  vec3 normal_tag;
  vec3 color;
  vec3 exit_radiance;
} surface;

// Exposed linear in the plate's primaries.
layout(location = 0) out vec4 object_color;
layout(location = 1) out vec4 reflection_color;
layout(location = 2) out vec4 normal_depth;  // camera frame; metres along z

vec3 shading_normal(vec3 to_viewer) {
  vec3 n = surface.normal_tag / max(length(surface.normal_tag), 1e-20);
  if (!gl_FrontFacing) n = -n;
  // An interpolated normal may look away from the viewer at the silhouette: bend it back to grazing.
  float n_v = dot(n, to_viewer);
  return n_v >= 0.0 ? n : normalize(n - n_v * to_viewer);
}

// A pixel of a curved mirror sees many texels: average over the pixel's footprint (a 2 x 2 grid of it).
vec3 mirrored_radiance(vec3 direction, float level) {
  vec3 dx = 0.25 * dFdx(direction), dy = 0.25 * dFdy(direction);
  if (level >= 1.0) return textureLod(probe, direction, level).rgb;
  return 0.25 * (textureLod(probe, direction + dx + dy, level).rgb + textureLod(probe, direction + dx - dy, level).rgb +
                 textureLod(probe, direction - dx + dy, level).rgb + textureLod(probe, direction - dx - dy, level).rgb);
}

vec3 exposed(vec3 radiance) {
  vec3 light = view.exposure.rgb * (mat3(view.plate_from_rec709) * radiance);
  // Never NaN, infinite or negative (out of the plate's gamut): one such pixel would spread with the glare.
  return mix(vec3(0.0), min(light, vec3(1e9)), greaterThan(light, vec3(0.0)));
}

void main() {
  vec3 to_viewer = normalize(view.camera_in_tag_m.xyz - surface.position_tag_m);
  vec3 n = shading_normal(to_viewer);
  float roughness = material.emissive_roughness.a;
  float metallic = material.base_color_metallic.a;
  vec2 table = texture(brdf_table, vec2(clamp(dot(n, to_viewer), 0.0, 1.0), roughness)).rg;

  vec3 f0 = mix(vec3(material.dielectric.x), material.base_color_metallic.rgb * surface.color, metallic);
  float f90 = mix(material.dielectric.y, 1.0, metallic);
  vec3 direction = mat3(view.light_from_tag) * reflect(-to_viewer, n);
  float level = roughness * float(textureQueryLevels(probe) - 1);
  vec3 reflected = mirrored_radiance(direction, level) * (f0 * table.x + f90 * table.y);

  // What the dielectric boundary mirrors does not reach the pigment below it.
  float entering = 1.0 - (material.dielectric.x * table.x + material.dielectric.y * table.y);
  vec3 radiance = surface.exit_radiance * entering + reflected + material.emissive_roughness.rgb;

  object_color = vec4(exposed(radiance), 1.0);
  reflection_color = vec4(exposed(reflected), 1.0);
  normal_depth = vec4(mat3(view.camera_from_tag) * n, (view.camera_from_tag * vec4(surface.position_tag_m, 1.0)).z);
}
