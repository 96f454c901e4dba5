// Precomputed radiance transfer (Sloan, Kautz & Snyder 2002), any number of bands: light leaving (or reaching) point gl_VertexID
// = sum of light coefficient times transfer coefficient. Captured into a buffer; nothing is drawn.
#version 450 core
#include "interface.h"

// Plain floats: an array of vec3 would be padded to 16 bytes each.
layout(std430, binding = BINDING_TRANSFER) readonly buffer TransferBlock { float transfer[]; };
layout(std430, binding = BINDING_DIRECT_TRANSFER) readonly buffer DirectTransferBlock { float direct_transfer[]; };

out vec3 transferred;

void main() {
  int first = gl_VertexID * light.count.x;
  vec3 sum = vec3(0.0);
  for (int i = 0; i < light.count.x; ++i) {
    int at = 3 * (first + i);
    sum += light.coefficients[i].rgb * vec3(transfer[at], transfer[at + 1], transfer[at + 2]);
  }
  // Straight from the lights comes what their shadow maps let through, not this.
  for (int i = 0; light.count.y != 0 && i < light.count.x; ++i) {
    int at = 3 * (first + i);
    sum -= light.split_off[i].rgb * vec3(direct_transfer[at], direct_transfer[at + 1], direct_transfer[at + 2]);
  }
  // Few bands ring below zero around strong lights; light cannot. The comparison is false for NaN as well.
  transferred = mix(vec3(0.0), sum, greaterThan(sum, vec3(0.0)));
  gl_Position = vec4(0.0);
}
