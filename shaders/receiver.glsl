// Shadow on the receiver as the ratio of shadowed to unshadowed irradiance (Debevec 1998), smoothed between grid points by a cubic B-spline.
layout(binding = TEXTURE_RECEIVER_LIGHT) uniform sampler2D receiver_light;      // linear filter; irradiance / pi of the lights
layout(binding = TEXTURE_RATIO) uniform sampler2D receiver_irradiance;  // linear filter; a texel a grid point

// More than this is no shadow's bounce but a defect of the transfer.
const float kMaxRatio = 4.0;
// The outermost points fade to 1: the end of the grid must not be seen.
const float kFadePoints = 3.0;

// Cubic B-spline by four bilinear reads (Sigg & Hadwiger, GPU Gems 2, chapter 20).
vec3 smooth_irradiance(vec2 grid_position) {
  vec2 size = vec2(receiver.points.xy);
  vec2 base = floor(grid_position), f = grid_position - base;
  vec2 w0 = (1.0 - f) * (1.0 - f) * (1.0 - f) / 6.0, w3 = f * f * f / 6.0;
  vec2 w1 = 2.0 / 3.0 - 0.5 * f * f * (2.0 - f);
  vec2 low = w0 + w1, high = 1.0 - low;
  vec2 at_low = (base - 0.5 + w1 / low) / size, at_high = (base + 1.5 + w3 / high) / size;
  return low.y * (low.x * texture(receiver_irradiance, at_low).rgb + high.x * texture(receiver_irradiance, vec2(at_high.x, at_low.y)).rgb) +
         high.y * (low.x * texture(receiver_irradiance, vec2(at_low.x, at_high.y)).rgb + high.x * texture(receiver_irradiance, at_high).rgb);
}

// 1 well within a rectangle of `size` texels, 0 at its rim.
float rim_fade(vec2 texel, vec2 size) {
  vec2 to_rim = min(texel, size - texel);
  return smoothstep(0.0, kFadePoints, min(to_rim.x, to_rim.y));
}

// The ratio at `place` on the plane (tag x, y).
vec3 shadow_ratio(vec2 place) {
  vec2 cells = (place - receiver.min_max_m.xy) / (receiver.min_max_m.zw - receiver.min_max_m.xy) * vec2(receiver.points.xy - 1);
  vec2 within = (place - receiver.lights_min_max_m.xy) / (receiver.lights_min_max_m.zw - receiver.lights_min_max_m.xy);
  float fade = rim_fade(cells, vec2(receiver.points.xy - 1));
  float light_fade = receiver.light_texels.x > 0.0 ? rim_fade(within * receiver.light_texels.xy, receiver.light_texels.xy) : 0.0;
  if (!(fade > 0.0 || light_fade > 0.0)) return vec3(1.0);
  vec3 sum = receiver.unshadowed_rest.rgb + receiver.unshadowed_lights.rgb;
  if (fade > 0.0) sum += fade * (smooth_irradiance(cells) - receiver.unshadowed_rest.rgb);
  if (light_fade > 0.0) sum += light_fade * (texture(receiver_light, within).rgb - receiver.unshadowed_lights.rgb);
  vec3 ratio = sum * receiver.one_over_unshadowed.rgb;
  return mix(vec3(1.0), clamp(ratio, 0.0, kMaxRatio), greaterThanEqual(ratio, vec3(0.0)));  // NaN: no shadow
}
