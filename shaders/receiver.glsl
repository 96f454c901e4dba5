// Shadow on the receiver as the ratio of shadowed to unshadowed irradiance (Debevec 1998), smoothed between grid points by a cubic B-spline.
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

// `grid_position` in grid points, 0 at the first.
vec3 shadow_ratio(vec2 grid_position) {
  vec2 to_rim = min(grid_position, vec2(receiver.points.xy - 1) - grid_position);
  float fade = smoothstep(0.0, kFadePoints, min(to_rim.x, to_rim.y));
  if (!(fade > 0.0)) return vec3(1.0);
  vec3 value = smooth_irradiance(grid_position) * receiver.one_over_unshadowed.rgb;
  value = mix(vec3(1.0), clamp(value, 0.0, kMaxRatio), greaterThanEqual(value, vec3(0.0)));  // NaN: no shadow
  return mix(vec3(1.0), value, fade);
}
