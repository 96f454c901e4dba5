// Counts the frame's luminances: render/tone/tone_curve.hpp's LuminanceHistogram. Only whole numbers are added, in any order.
#version 450 core
#include "interface.h"

layout(binding = TEXTURE_SOURCE) uniform sampler2D scene;  // linear
uniform vec3 luminance_weights;
layout(std430, binding = BINDING_LUMINANCES) buffer Luminances { uint bins[]; };  // count and sum of the rest (two words), a bin each

const uint kRestBits = 17;                                   // bits below a bin's, of 23 in the mantissa: 64 bins an octave
const uint kFirst = ((127u - 32u) << (23u - kRestBits)) - 1;  // bin 1 starts at 2^-32

void main() {
  float luminance = dot(luminance_weights, texelFetch(scene, ivec2(gl_FragCoord.xy), 0).rgb);
  if (isnan(luminance)) return;
  if (luminance < 1.0 / 4294967296.0) {
    atomicAdd(bins[0], 1u);
    return;
  }
  uint bits = floatBitsToUint(min(luminance, 4294967040.0));
  uint at = 3u * ((bits >> kRestBits) - kFirst), rest = bits & ((1u << kRestBits) - 1u);
  atomicAdd(bins[at], 1u);
  uint before = atomicAdd(bins[at + 1u], rest);
  if (before + rest < before) atomicAdd(bins[at + 2u], 1u);
}
