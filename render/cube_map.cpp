#include "render/cube_map.hpp"

#include <algorithm>
#include <cmath>

#include "render/probe_layouts.hpp"

namespace catchlight::render {
namespace {

double corner_solid_angle(double s, double t) {
  return std::atan2(s * t, std::sqrt(s * s + t * t + 1));
}

}  // namespace

CubeLevel::CubeLevel(const Image& stacked)
    : size_(stacked.width), stride_(size_ + 2), texels_(static_cast<std::size_t>(6) * stride_ * stride_) {
  for (int face = 0; face < 6; ++face) {
    for (int y = 0; y < size_; ++y) {
      for (int x = 0; x < size_; ++x) {
        const float* value = stacked.pixel(x, face * size_ + y);
        texel(face, x, y) = {value[0], value[1], value[2]};
      }
    }
  }
  for (int face = 0; face < 6; ++face) fill_border(face);
}

// The texel beyond a border is the neighbour's that lies in its direction; beyond a corner three faces meet, and it is their
// mean.
void CubeLevel::fill_border(int face) {
  const auto beyond = [&](int x, int y) {
    const glm::dvec3 direction = cube_direction(face, (2 * x + 1.0) / size_ - 1, (2 * y + 1.0) / size_ - 1);
    const int other = face_of(gl_cube_faces(), direction);
    const glm::dvec2 position = (position_on_face(gl_cube_faces()[other], direction) + 1.0) / 2.0 * static_cast<double>(size_);
    const auto index = [&](double at) { return std::clamp(static_cast<int>(std::floor(at)), 0, size_ - 1); };
    return texel(other, index(position.x), index(position.y));
  };
  const int last = size_ - 1;
  for (int i = 0; i < size_; ++i) {
    texel(face, i, -1) = beyond(i, -1);
    texel(face, i, size_) = beyond(i, size_);
    texel(face, -1, i) = beyond(-1, i);
    texel(face, size_, i) = beyond(size_, i);
  }
  for (const int x : {0, last}) {
    for (const int y : {0, last}) {
      const int out_x = x == 0 ? -1 : size_, out_y = y == 0 ? -1 : size_;
      texel(face, out_x, out_y) = (texel(face, x, y) + texel(face, out_x, y) + texel(face, x, out_y)) / 3.0f;
    }
  }
}

glm::vec3 CubeLevel::sample(const glm::vec3& direction) const {
  // OpenGL 4.5 core, table 8.19.
  const glm::vec3 size = glm::abs(direction);
  int face = 0;
  float s = 0, t = 0, major = 0;
  if (size.x >= size.y && size.x >= size.z) {
    face = direction.x >= 0 ? 0 : 1, major = size.x, s = direction.x >= 0 ? -direction.z : direction.z, t = -direction.y;
  } else if (size.y >= size.z) {
    face = direction.y >= 0 ? 2 : 3, major = size.y, s = direction.x, t = direction.y >= 0 ? direction.z : -direction.z;
  } else {
    face = direction.z >= 0 ? 4 : 5, major = size.z, s = direction.z >= 0 ? direction.x : -direction.x, t = -direction.y;
  }
  const float x = (s / major + 1) * 0.5f * static_cast<float>(size_) - 0.5f,
              y = (t / major + 1) * 0.5f * static_cast<float>(size_) - 0.5f;
  const int left = std::clamp(static_cast<int>(std::floor(x)), -1, size_ - 1),
            top = std::clamp(static_cast<int>(std::floor(y)), -1, size_ - 1);
  const float right = x - static_cast<float>(left), down = y - static_cast<float>(top);
  return glm::mix(glm::mix(texel(face, left, top), texel(face, left + 1, top), right),
                  glm::mix(texel(face, left, top + 1), texel(face, left + 1, top + 1), right), down);
}

double cube_texel_solid_angle(int size, int x, int y) {
  const double left = 2.0 * x / size - 1, right = 2.0 * (x + 1) / size - 1, top = 2.0 * y / size - 1,
               bottom = 2.0 * (y + 1) / size - 1;
  return corner_solid_angle(right, bottom) - corner_solid_angle(left, bottom) - corner_solid_angle(right, top) +
         corner_solid_angle(left, top);
}

Image halved_cube(const Image& stacked) {
  const int size = stacked.width / 2;
  Image half(size, 6 * size);
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < size; ++x) {
      glm::dvec3 sum(0);
      double weights = 0;
      for (int k = 0; k < 4; ++k) {
        const int fine_x = 2 * x + k % 2, fine_y = 2 * y + k / 2;
        const double weight = cube_texel_solid_angle(stacked.width, fine_x, fine_y % stacked.width);
        const float* value = stacked.pixel(fine_x, fine_y);
        sum += weight * glm::dvec3(value[0], value[1], value[2]);
        weights += weight;
      }
      for (int c = 0; c < 3; ++c) half.pixel(x, y)[c] = static_cast<float>(sum[c] / weights);
    }
  }
  return half;
}

glm::dvec3 cube_direction(int face, double s, double t) {
  const CubeFace& axes = gl_cube_faces()[face];
  return glm::normalize(axes.centre + s * axes.right + t * axes.down);
}

}  // namespace catchlight::render
