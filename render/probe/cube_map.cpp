#include "render/probe/cube_map.hpp"

#include <cmath>

#include "render/probe/probe_layouts.hpp"

namespace catchlight::render {

glm::dvec3 cube_direction(int face, double s, double t) {
  const CubeFace& axes = gl_cube_faces()[face];
  return glm::normalize(axes.centre + s * axes.right + t * axes.down);
}

double cube_texel_solid_angle(int size, int x, int y) {
  const double left = 2.0 * x / size - 1, right = 2.0 * (x + 1) / size - 1;
  const double top = 2.0 * y / size - 1, bottom = 2.0 * (y + 1) / size - 1;
  const auto corner = [](double s, double t) { return std::atan2(s * t, std::sqrt(s * s + t * t + 1)); };
  return corner(right, bottom) - corner(left, bottom) - corner(right, top) + corner(left, top);
}

}  // namespace catchlight::render
