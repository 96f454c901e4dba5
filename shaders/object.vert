#version 450 core
#include "interface.h"
#include "distortion.glsl"

layout(location = ATTRIBUTE_POSITION) in vec3 position_m;
layout(location = ATTRIBUTE_NORMAL) in vec3 normal;
layout(location = ATTRIBUTE_COLOR) in vec3 color;
layout(location = ATTRIBUTE_IRRADIANCE) in vec3 irradiance_over_pi;
layout(location = ATTRIBUTE_MIRRORS_OBJECT) in float mirrors_object;

// Not centroid: the covered samples' place would shift reflections by up to 0.4 px wherever facets are as small as pixels.
out Surface {
  vec3 position_tag_m;
  vec3 normal_tag;
  vec3 color;
  vec3 irradiance_over_pi;
  float mirrors_object;  // 0: nothing of the object lies above any corner
} surface;

void main() {
  surface.position_tag_m = position_m;
  surface.normal_tag = normal;
  surface.color = color;
  surface.irradiance_over_pi = irradiance_over_pi;
  surface.mirrors_object = mirrors_object;
  gl_Position = clip_from_tag(position_m);
}
