// The drawn part of the receiving plane in RECEIVER_CELLS x RECEIVER_CELLS cells, so that lenses may bend it: instance = row, a triangle
// strip along the columns.
#version 450 core
#include "interface.h"
#include "distortion.glsl"

out vec2 place;  // tag x, y

void main() {
  vec2 share = vec2(gl_VertexID >> 1, gl_InstanceID + (gl_VertexID & 1)) / float(RECEIVER_CELLS);
  place = mix(receiver.drawn_min_max_m.xy, receiver.drawn_min_max_m.zw, share);
  gl_Position = clip_from_tag(vec3(place, 0.0));
}
