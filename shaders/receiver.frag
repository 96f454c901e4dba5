#version 450 core
#include "interface.h"
#include "receiver.glsl"

in vec2 grid_position;  // in grid points, 0 at the first
layout(location = 0) out vec4 ratio;

void main() { ratio = vec4(shadow_ratio(grid_position), 1.0); }
