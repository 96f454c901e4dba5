#version 450 core
#include "interface.h"
#include "lens.glsl"

layout(location = ATTRIBUTE_POSITION) in vec3 position_m;
layout(location = ATTRIBUTE_NORMAL) in vec3 normal;
layout(location = ATTRIBUTE_COLOR) in vec3 color;
layout(location = ATTRIBUTE_EXIT_RADIANCE) in vec3 exit_radiance;

// At the silhouette the pixel's centre may lie outside the triangle: centroid keeps what is interpolated inside it.
out Surface {
  centroid vec3 position_tag_m;
  centroid vec3 normal_tag;
  centroid vec3 color;
  centroid vec3 exit_radiance;
} surface;

void main() {
  surface.position_tag_m = position_m;
  surface.normal_tag = normal;
  surface.color = color;
  surface.exit_radiance = exit_radiance;
  gl_Position = clip_from_tag(position_m);
}
