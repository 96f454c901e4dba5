// Object, shadow and glare put into the plate in linear light (Debevec 1998; premultiplied over), then coded as the plate was.
#version 450 core
#include "interface.h"
#include "bspline.glsl"
#include "color.glsl"
#include "sensor_noise.glsl"

layout(binding = TEXTURE_OBJECT) uniform sampler2D object;    // premultiplied exposed linear
layout(binding = TEXTURE_SHADOW) uniform sampler2D shadow;    // ratio
layout(binding = TEXTURE_PLATE) uniform sampler2D plate;      // codes
layout(binding = TEXTURE_GLARE) uniform sampler2D glare_grid; // exposed linear
layout(binding = TEXTURE_REFLECTION) uniform sampler2D reflection; // as the object, of which it is a part; layers alone read it

layout(location = 0) out vec4 result;  // codes, alpha 1 where changed; or linear light
// Layers, linear: result = plate * shadow * (1 - object.a) + object + glare.
layout(location = 1) out vec4 plate_layer;
layout(location = 2) out vec4 object_layer;
layout(location = 3) out vec4 shadow_layer;
layout(location = 4) out vec4 glare_layer;
layout(location = 5) out vec4 reflection_layer;

vec3 finite_or_zero(vec3 v) { return mix(v, vec3(0.0), bvec3(uvec3(isnan(v)) | uvec3(isinf(v)))); }

vec3 glare_at(ivec2 pixel) {
  if (composite.modes.z == 0) return vec3(0.0);
  if (composite.modes.z == 2) return texelFetch(glare_grid, pixel, 0).rgb;  // an aperture's glare, at the frame's own resolution
  // Catmull-Rom's cubic under the streaks may undershoot by a little.
  return max(bspline(glare_grid, (vec2(pixel) + 0.5) * composite.glare_from_frame.xy + composite.glare_from_frame.zw), 0.0);
}

// Share of the light at the tag that reaches this place of the sensor.
float vignetting_at(ivec2 pixel) {
  vec2 off = vec2(pixel) - composite.vignetting_at.xy;
  float r2 = dot(off, off) * composite.vignetting_at.z;
  vec3 v = composite.vignetting.xyz;
  return max(1.0 + r2 * (v.x + r2 * (v.y + r2 * v.z)), 0.0) * composite.vignetting.w;
}

void main() {
  ivec2 local = ivec2(gl_FragCoord.xy), pixel = local + composite.output_rect.xy;
  ivec2 in_virtual = pixel - composite.virtual_rect.xy;
  bool reached = all(greaterThanEqual(in_virtual, ivec2(0))) && all(lessThan(in_virtual, composite.virtual_rect.zw));
  vec4 over = reached ? texelFetch(object, in_virtual, 0) : vec4(0.0);
  vec3 ratio = reached ? texelFetch(shadow, in_virtual, 0).rgb : vec3(1.0);
  float passed = vignetting_at(pixel);
  over.rgb *= passed;
  vec3 glare = glare_at(pixel);
  vec3 code = texelFetch(plate, pixel - composite.plate_rect.xy, 0).rgb;

  // Black is light the lens scatters: no shadow takes it away, and the object stands behind it too.
  int transfer = composite.modes.x;
  vec3 background = finite_or_zero(linear_from_code(transfer, code));
  vec3 black = composite.black.rgb;
  // Where the plate is clipped the receiver is brighter than it shows, and so is its shadow.
  bvec3 clipped = composite.modes.y != 0 ? greaterThanEqual(code, composite.code_limits.yyy) : bvec3(false);
  vec3 lit = mix(background, max(background, composite.receiver_light.rgb), clipped);
  vec3 shadowed = max(lit - black, 0.0) * ratio + min(background, black);
  over.rgb += over.a * black;
  vec3 light = shadowed * (1.0 - over.a) + over.rgb + glare;

  bool untouched = over.a == 0.0 && ratio == vec3(1.0) && glare == vec3(0.0);
  if (composite.noise.x != 0 && !untouched) light += missing_noise(pixel, light, background, (1.0 - over.a) * ratio);
  vec3 new_code = untouched ? code : code_from_linear(transfer, light);
  if (composite.modes.y != 0) new_code = clamp(new_code, 0.0, 1.0);
  // A NaN in the plate compares as changed once something virtual covers it.
  bool changed = !untouched && !all(lessThanEqual(abs(new_code - code), composite.code_limits.xxx));
  result = composite.modes.w != 0 ? vec4(light, 1.0) : vec4(new_code, changed ? 1.0 : 0.0);  // tone.frag goes on from light

  plate_layer = vec4(background, 1.0);
  object_layer = over;
  shadow_layer = vec4(mix(vec3(1.0), shadowed / background, greaterThan(background, vec3(0.0))), 1.0);
  glare_layer = vec4(glare, 1.0);
  reflection_layer = reached ? vec4(passed * texelFetch(reflection, in_virtual, 0).rgb, 1.0) : vec4(0.0);
}
