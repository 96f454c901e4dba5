// A texture as a cubic B-spline whose coefficients are its texels, by four bilinear reads (Sigg and Hadwiger, GPU Gems 2, chapter 20):
// smooth, never negative where the texels are not, of variance 1/3 texel squared.

/// `texel`: position in texels; the first one's centre is at 0.5.
vec3 bspline(sampler2D image, vec2 texel) {
  vec2 size = vec2(textureSize(image, 0)), first = floor(texel - 0.5), f = texel - 0.5 - first, g = 1.0 - f;
  vec2 w0 = g * g * g / 6.0, w3 = f * f * f / 6.0;
  vec2 w1 = (4.0 - 6.0 * f * f + 3.0 * f * f * f) / 6.0;
  vec2 low = w0 + w1, high = 1.0 - low;
  vec2 a = (first - 0.5 + w1 / low) / size, b = (first + 1.5 + w3 / high) / size;
  return low.y * (low.x * texture(image, a).rgb + high.x * texture(image, vec2(b.x, a.y)).rgb) +
         high.y * (low.x * texture(image, vec2(a.x, b.y)).rgb + high.x * texture(image, b).rgb);
}
