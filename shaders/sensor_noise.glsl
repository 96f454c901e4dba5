// The sensor's noise on what is virtual. Integers up to the last step: every GPU draws the same.

// pcg4d (Jarzynski & Olano 2020, "Hash Functions for GPU Rendering").
uvec4 hash(uvec4 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.w, v.y += v.z * v.x, v.z += v.x * v.y, v.w += v.y * v.z;
  v ^= v >> 16u;
  v.x += v.y * v.w, v.y += v.z * v.x, v.z += v.x * v.y, v.w += v.y * v.z;
  return v;
}

// Mean 0, variance 1: the sum of eight uniform numbers, which is normal but for a kurtosis 0.15 too small.
float gaussian(ivec2 place, uint stream) {
  uvec4 h = hash(uvec4(place, uint(composite.noise.y), stream));
  uvec4 halves = (h & 0xffffu) + (h >> 16u);
  return (float(halves.x + halves.y + halves.z + halves.w) - 262140.0) / 53509.9;
}

// A pixel keeps the noise of what it keeps of the plate, and so needs the rest: none where nothing was touched, all of it where
// the object covers.
vec3 missing_noise(ivec2 pixel, vec3 light, vec3 background, vec3 kept) {
  vec3 slope = composite.noise_slope.rgb, floor_ = composite.noise_floor.rgb;
  vec3 wanted = max(slope * max(light, 0.0) + floor_, 0.0);
  vec3 there = kept * kept * max(slope * max(background, 0.0) + floor_, 0.0);
  ivec2 block = pixel >> composite.noise.zw;
  vec3 unit = mat3(composite.noise_mix) * vec3(gaussian(block, 0u), gaussian(block, 1u), gaussian(pixel, 2u));
  return sqrt(max(wanted - there, 0.0)) * unit;
}
