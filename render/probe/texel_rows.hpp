// Directions and texels of a probe's layout, many at once.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "render/probe/probe_layouts.hpp"

namespace catchlight::render {

/// Values of many directions or places, one array a coordinate.
struct Coordinates3 {
  std::vector<double> x, y, z;
  explicit Coordinates3(std::size_t count) : x(count), y(count), z(count) {}
};
struct Coordinates2 {
  std::vector<double> x, y;
  explicit Coordinates2(std::size_t count) : x(count), y(count) {}
};

/// texel_from_direction of each direction, of any length.
void texels_from_directions(ProbeLayout layout, int width, int height, const Coordinates3& directions, Coordinates2& texels);

/// What direction_from_texel and texel_solid_angle say of whole texels, row by row; a latlong's sines and cosines are computed
/// once.
class TexelRows {
 public:
  TexelRows(ProbeLayout layout, int width, int height);

  std::optional<glm::dvec3> direction(int x, int y) const {
    if (sin_latitude_.empty()) return direction_from_texel(layout_, width_, height_, x, y);
    return glm::dvec3(sin_longitude_[x] * cos_latitude_[y], sin_latitude_[y], cos_longitude_[x] * cos_latitude_[y]);
  }
  double solid_angle(int x, int y) const {
    if (sin_latitude_.empty()) return texel_solid_angle(layout_, width_, height_, x, y);
    return x == 0 || x == width_ - 1 ? outer_column_sr_[y] : inner_column_sr_[y];
  }

 private:
  ProbeLayout layout_;
  int width_, height_;
  std::vector<double> sin_longitude_, cos_longitude_, sin_latitude_, cos_latitude_;  ///< empty for other layouts
  std::vector<double> inner_column_sr_, outer_column_sr_;                            ///< solid angles, by row
};

}  // namespace catchlight::render
