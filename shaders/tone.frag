// The photographic operator, extended (Reinhard et al. 2002; render/tone/tone_curve.cpp has the same), then the footage's response.
#version 450 core
#include "interface.h"
#include "color.glsl"

layout(binding = TEXTURE_SOURCE) uniform sampler2D scene;  // linear light
layout(binding = TEXTURE_BLOOM) uniform sampler2D bloom;   // bloom of the classic look, in the scene's units
layout(binding = TEXTURE_STREAKS) uniform sampler2D streaks;
uniform vec2 curve;                                        // gain, 1 / white^2
uniform vec3 luminance_weights;
uniform vec2 glare_strength;                               // strength of bloom and streaks
uniform vec2 one_over_frame;

layout(location = 0) out vec4 result;  // codes

const float kMaxLight = 1e9;

vec3 sane(vec3 v) { return clamp(mix(v, vec3(0.0), isnan(v)), -kMaxLight, kMaxLight); }

vec3 toned(vec3 light) {
  float exposed = curve.x * max(dot(luminance_weights, light), 0.0);
  return light * (curve.x * (1.0 + exposed * curve.y) / (1.0 + exposed));
}

// A colour beyond the codes is mixed with the grey of its luminance until it fits.
vec3 within_codes(vec3 light) {
  float luminance = dot(luminance_weights, light), peak = max(light.r, max(light.g, light.b));
  if (peak <= 1.0) return light;
  return luminance >= 1.0 ? vec3(1.0) : mix(vec3(luminance), light, (1.0 - luminance) / (peak - luminance));
}

void main() {
  vec2 at = gl_FragCoord.xy * one_over_frame;
  vec3 light = sane(texelFetch(scene, ivec2(gl_FragCoord.xy), 0).rgb);
  light += glare_strength.x * texture(bloom, at).rgb + glare_strength.y * texture(streaks, at).rgb;
  light = toned(light);
  bool codes_end_at_1 = composite.modes.y != 0;
  vec3 code = code_from_linear(composite.modes.x, codes_end_at_1 ? within_codes(light) : light);
  if (codes_end_at_1) code = clamp(code, 0.0, 1.0);
  result = vec4(code, 1.0);
}
