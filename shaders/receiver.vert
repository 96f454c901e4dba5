// The grid of the receiving plane: instance = row, a triangle strip along the columns.
#version 450 core
#include "interface.h"
#include "lens.glsl"

out vec2 grid_position;  // in grid points, 0 at the first

void main() {
  grid_position = vec2(gl_VertexID >> 1, gl_InstanceID + (gl_VertexID & 1));
  vec2 share = grid_position / vec2(receiver.points.xy - 1);
  gl_Position = clip_from_tag(vec3(mix(receiver.min_max_m.xy, receiver.min_max_m.zw, share), 0.0));
}
