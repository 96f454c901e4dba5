#version 450 core
#include "interface.h"
#include "receiver.glsl"

in vec2 place;  // tag x, y
layout(location = 0) out vec4 ratio;

void main() { ratio = vec4(shadow_ratio(place), 1.0); }
