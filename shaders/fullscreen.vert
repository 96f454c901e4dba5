// One triangle over the whole viewport; where a vertex array is drawn from the fourth vertex on, its corners.
#version 450 core
#include "interface.h"

layout(location = ATTRIBUTE_POSITION) in vec2 corner;

void main() {
  vec2 whole = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(gl_VertexID < 3 ? whole : corner, 0.0, 1.0);
}
