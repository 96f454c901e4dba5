// The same as distorted() of catchlight/projection.hpp, see there.
float radial_factor(float r2) {
  vec3 powers = vec3(r2, r2 * r2, r2 * r2 * r2);
  return (1.0 + dot(view.radial_numerator.xyz, powers)) / (1.0 + dot(view.radial_denominator.xyz, powers));
}

vec2 tangential_shift(vec2 p) {
  float p1 = view.tangential.x, p2 = view.tangential.y, r2 = dot(p, p);
  return vec2(2.0 * p1 * p.x * p.y + p2 * (r2 + 2.0 * p.x * p.x), p1 * (r2 + 2.0 * p.y * p.y) + 2.0 * p2 * p.x * p.y);
}

vec3 distorted(vec3 p) {
  float limit = view.distortion_limit.x;
  float rho = length(p.xy);
  if (p.z > 0.0 && rho <= limit * p.z) {
    vec2 n = p.xy / p.z;
    return vec3((n * radial_factor(dot(n, n)) + tangential_shift(n)) * p.z, p.z);
  }
  if (rho == 0.0) return p;
  vec2 direction = p.xy / rho;
  float radius = view.distortion_limit.y * p.z + view.distortion_limit.z * (rho - limit * p.z);
  return vec3(direction * radius + tangential_shift(direction * limit) * p.z, p.z);
}

vec4 clip_from_tag(vec3 point_tag_m) {
  vec3 point_camera_m = (view.camera_from_tag * vec4(point_tag_m, 1.0)).xyz;
  return view.clip_from_camera * vec4(distorted(point_camera_m), 1.0);
}
