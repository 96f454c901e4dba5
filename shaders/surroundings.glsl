// What lies around the object: the receiver, seen in the frame itself where the frame shows it, and the probe.
layout(binding = TEXTURE_PROBE) uniform samplerCube probe;         // level by perceptual roughness
layout(binding = TEXTURE_REST) uniform samplerCube rest;           // the same less the lights that make highlights
layout(binding = TEXTURE_PLATE_LIGHT) uniform sampler2D plate_light;  // whole frame, radiance, mip levels

// Over the outer share of the frame the probe takes over from it.
const float kFrameFade = 0.04;

vec3 probe_radiance(vec3 direction_tag, float roughness, bool with_lights) {
  vec3 direction = mat3(view.light_from_tag) * direction_tag;
  if (with_lights) return textureLod(probe, direction, level_of(roughness, textureQueryLevels(probe))).rgb;
  return textureLod(rest, direction, level_of(roughness, textureQueryLevels(rest))).rgb;
}

// How much the frame is to be trusted at clip position `clip`: 0 outside it.
float seen_in_frame(vec4 clip) {
  if (clip.w <= 0.0) return 0.0;
  vec2 to_rim = 1.0 - abs(clip.xy / clip.w);
  return smoothstep(0.0, 2.0 * kFrameFade, min(to_rim.x, to_rim.y));
}

// Radiance of the plane z = 0 at `point`, blurred over `width_m`; darkened by the object. Where the frame does not show the place, the
// probe does, from where it was captured.
vec3 receiver_radiance(vec2 point, float width_m, float roughness) {
  vec3 ratio = shadow_ratio(point);
  vec3 from_probe = probe_radiance(normalize(vec3(point, 0.0) - view.probe_in_tag_m.xyz), roughness, true);
  vec4 clip = clip_from_tag(vec3(point, 0.0));
  float seen = seen_in_frame(clip);
  if (seen == 0.0) return ratio * from_probe;
  vec2 size = vec2(textureSize(plate_light, 0));
  float pixels = width_m * view.frame.z / clip.w;
  vec3 from_frame = textureLod(plate_light, clip.xy / clip.w * 0.5 + 0.5, max(log2(pixels), 0.0)).rgb;
  return ratio * mix(from_probe, from_frame, seen);
}

// Radiance that arrives at `origin` from `direction` past the object; `spread` is the tangent of the ray's half width.
vec3 surroundings(vec3 origin, vec3 direction, float spread, float roughness, bool with_lights) {
  if (view.options.y == 0 || direction.z >= 0.0 || origin.z <= 0.0) return probe_radiance(direction, roughness, with_lights);
  float distance_m = -origin.z / direction.z;
  return receiver_radiance(origin.xy + distance_m * direction.xy, 2.0 * spread * distance_m, roughness);
}
