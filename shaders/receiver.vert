// The drawn part of the receiving plane in RECEIVER_CELLS x RECEIVER_CELLS cells, so that lenses may bend it: instance = row, a triangle
// strip along the columns. Cells are small near the object, for shadows reach far.
#version 450 core
#include "interface.h"
#include "distortion.glsl"

out vec2 place;  // tag x, y

void main() {
  vec2 share = vec2(gl_VertexID >> 1, gl_InstanceID + (gl_VertexID & 1)) / float(RECEIVER_CELLS);
  vec2 t = 2.0 * share - 1.0, middle = 0.5 * (receiver.min_max_m.xy + receiver.min_max_m.zw);
  vec2 rim = mix(receiver.drawn_min_max_m.xy, receiver.drawn_min_max_m.zw, step(0.0, t));
  place = middle + (rim - middle) * mix(abs(t * t * t), abs(t), 0.1);
  gl_Position = clip_from_tag(vec3(place, 0.0));
}
