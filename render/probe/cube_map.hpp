// Faces of cube maps in OpenGL's orientation: +x -x +y -y +z -z.
#pragma once

#include <glm/glm.hpp>

namespace catchlight::render {

/// Direction (length 1) of face coordinates (s, t) in [-1, 1], s right, t down.
glm::dvec3 cube_direction(int face, double s, double t);

/// Direction (length 1) of the centre of texel (x, y).
inline glm::dvec3 cube_texel_direction(int face, int size, int x, int y) {
  return cube_direction(face, (2 * x + 1.0) / size - 1, (2 * y + 1.0) / size - 1);
}

/// Solid angle (sr) of texel (x, y) of a face.
double cube_texel_solid_angle(int size, int x, int y);

}  // namespace catchlight::render
