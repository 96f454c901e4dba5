// A Gaussian of 3 texels along one axis, 15 taps of unit sum.
#version 450 core
#include "interface.h"

layout(binding = TEXTURE_SOURCE) uniform sampler2D source;
uniform ivec2 axis;
layout(location = 0) out vec4 result;

const int kReach = 7;
const float kSigma = 3.0;

void main() {
  vec2 one_over_size = 1.0 / vec2(textureSize(source, 0));
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (int i = -kReach; i <= kReach; ++i) {
    float weight = exp(-float(i * i) / (2.0 * kSigma * kSigma));
    sum += weight * texture(source, (gl_FragCoord.xy + vec2(i * axis)) * one_over_size).rgb;
    weights += weight;
  }
  result = vec4(sum / weights, 1.0);
}
