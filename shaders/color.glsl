// catchlight/response.hpp's linear_from_code() and its inverse, see there. 203 cd/m2 and HLG's code 0.75 are 1.
const float kPqScale = 10000.0 / 203.0, kHlgScale = 0.26496256;

vec3 linear_from_srgb(vec3 code) {
  vec3 magnitude = abs(code);
  return sign(code) * mix(pow((magnitude + 0.055) / 1.055, vec3(2.4)), magnitude / 12.92, lessThanEqual(magnitude, vec3(0.04045)));
}

vec3 srgb_from_linear(vec3 light) {
  vec3 magnitude = abs(light);
  return sign(light) *
         mix(1.055 * pow(magnitude, vec3(1.0 / 2.4)) - 0.055, magnitude * 12.92, lessThanEqual(magnitude, vec3(0.0031308)));
}

vec3 linear_from_pq(vec3 code) {
  vec3 root = pow(max(code, 0.0), vec3(32.0 / 2523.0));
  return kPqScale * pow(max(root - 0.8359375, 0.0) / (18.8515625 - 18.6875 * root), vec3(16384.0 / 2610.0));
}

vec3 pq_from_linear(vec3 light) {
  vec3 root = pow(max(light, 0.0) / kPqScale, vec3(2610.0 / 16384.0));
  return pow((0.8359375 + 18.8515625 * root) / (1.0 + 18.6875 * root), vec3(2523.0 / 32.0));
}

vec3 linear_from_hlg(vec3 code) {
  vec3 e = max(code, 0.0);
  return mix((exp((e - 0.55991073) / 0.17883277) + 0.28466892) / 12.0, e * e / 3.0, lessThanEqual(e, vec3(0.5))) / kHlgScale;
}

vec3 hlg_from_linear(vec3 light) {
  vec3 scene = max(light, 0.0) * kHlgScale;
  return mix(0.17883277 * log(max(12.0 * scene - 0.28466892, 1e-6)) + 0.55991073, sqrt(3.0 * scene), lessThanEqual(scene, vec3(1.0 / 12.0)));
}

// catchlight/response.hpp's ResponseCurve: the channels' tables one after the other.
layout(std430, binding = BINDING_RESPONSE) readonly buffer ResponseBlock { float response_light[]; };

float linear_from_curve(float code, int channel) {
  int steps = response_light.length() / 3 - 1, first = channel * (steps + 1);
  float place = code * float(steps);
  int at = clamp(int(place), 0, steps - 1);
  float from = response_light[first + at], to = response_light[first + at + 1];
  return from + (place - float(at)) * (to - from);
}

// The last step that begins at or below the light, by bisection: light rises from code to code.
float curve_from_linear(float light, int channel) {
  int steps = response_light.length() / 3 - 1, first = channel * (steps + 1);
  int low = 0, high = steps;
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (response_light[first + middle] <= light) low = middle; else high = middle;
  }
  float from = response_light[first + low], to = response_light[first + high];
  return (float(low) + (light - from) / (to - from)) / float(steps);
}

vec3 linear_from_code(int transfer, vec3 code) {
  switch (transfer) {
    case TRANSFER_SRGB: return linear_from_srgb(code);
    case TRANSFER_GAMMA22: return pow(max(code, 0.0), vec3(2.2));
    case TRANSFER_GAMMA28: return pow(max(code, 0.0), vec3(2.8));
    case TRANSFER_PQ: return linear_from_pq(code);
    case TRANSFER_HLG: return linear_from_hlg(code);
    case TRANSFER_CURVE: return vec3(linear_from_curve(code.r, 0), linear_from_curve(code.g, 1), linear_from_curve(code.b, 2));
    default: return code;
  }
}

vec3 code_from_linear(int transfer, vec3 light) {
  switch (transfer) {
    case TRANSFER_SRGB: return srgb_from_linear(light);
    case TRANSFER_GAMMA22: return pow(max(light, 0.0), vec3(1.0 / 2.2));
    case TRANSFER_GAMMA28: return pow(max(light, 0.0), vec3(1.0 / 2.8));
    case TRANSFER_PQ: return pq_from_linear(light);
    case TRANSFER_HLG: return hlg_from_linear(light);
    case TRANSFER_CURVE: return vec3(curve_from_linear(light.r, 0), curve_from_linear(light.g, 1), curve_from_linear(light.b, 2));
    default: return light;
  }
}
