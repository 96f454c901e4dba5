// Cube maps as OpenGL filters them: bilinear across the seams, with a chain of halved levels.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "render/image.hpp"

namespace catchlight::render {

/// One level: faces of size x size texels with a border of one texel taken from the faces next to them.
class CubeLevel {
 public:
  /// `stacked`: six faces +x -x +y -y +z -z in OpenGL's orientation, 3 channels.
  explicit CubeLevel(const Image& stacked);

  int size() const { return size_; }
  glm::vec3 sample(const glm::vec3& direction) const;

 private:
  const glm::vec3& texel(int face, int x, int y) const {
    return texels_[(static_cast<std::size_t>(face) * stride_ + y + 1) * stride_ + x + 1];
  }
  glm::vec3& texel(int face, int x, int y) {
    return texels_[(static_cast<std::size_t>(face) * stride_ + y + 1) * stride_ + x + 1];
  }
  void fill_border(int face);

  int size_, stride_;
  std::vector<glm::vec3> texels_;
};

/// Solid angle (sr) of texel (x, y) of a face.
double cube_texel_solid_angle(int size, int x, int y);

/// Half the size; each texel is the mean of four, weighted by solid angle, so the mean over all directions stays.
Image halved_cube(const Image& stacked);

/// Direction (length 1) of face coordinates (s, t) in [-1, 1], s right, t down.
glm::dvec3 cube_direction(int face, double s, double t);

}  // namespace catchlight::render
