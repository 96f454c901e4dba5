#include "render/probe/texel_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace catchlight::render {
namespace {

constexpr double kPi = std::numbers::pi;

// To 1e-10: a millionth of a texel of the largest probes. Taylor's series up to an eighth of a half turn; without branches, so
// that several go at once.
[[gnu::always_inline]] inline double quick_atan2(double y, double x) {
  const double abs_x = std::abs(x), abs_y = std::abs(y);
  const double larger = std::max(std::max(abs_x, abs_y), 1e-300), ratio = std::min(abs_x, abs_y) / larger;
  const bool is_wide = ratio > std::numbers::sqrt2 - 1;  // more than half of an eighth of the turn
  const double t = is_wide ? (ratio - 1) / (ratio + 1) : ratio, t2 = t * t;
  const double series =
      t *
      (1 + t2 * (-1.0 / 3 +
                 t2 * (1.0 / 5 +
                       t2 * (-1.0 / 7 +
                             t2 * (1.0 / 9 +
                                   t2 * (-1.0 / 11 +
                                         t2 * (1.0 / 13 + t2 * (-1.0 / 15 + t2 * (1.0 / 17 + t2 * (-1.0 / 19 + t2 / 21))))))))));
  const double first = series + (is_wide ? kPi / 4 : 0.0);
  const double half = abs_y > abs_x ? kPi / 2 - first : first;
  const double whole = x < 0 ? kPi - half : half;
  return std::copysign(whole, y);
}

[[gnu::target_clones("avx2", "default")]] void latlong_texels(int width, int height, std::size_t count, const double* x,
                                                              const double* y, const double* z, double* __restrict texel_x,
                                                              double* __restrict texel_y) {
  const double columns = width - 1, rows = height - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const double longitude = quick_atan2(x[i], z[i]), latitude = quick_atan2(y[i], std::sqrt(x[i] * x[i] + z[i] * z[i]));
    texel_x[i] = (0.5 - longitude / (2 * kPi)) * columns;
    texel_y[i] = (0.5 - latitude / kPi) * rows;
  }
}

}  // namespace

void texels_from_directions(ProbeLayout layout, int width, int height, const Coordinates3& directions, Coordinates2& texels) {
  const std::size_t count = directions.x.size();
  if (layout == ProbeLayout::latlong)
    return latlong_texels(width, height, count, directions.x.data(), directions.y.data(), directions.z.data(), texels.x.data(),
                          texels.y.data());
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec2 at =
        texel_from_direction(layout, width, height, glm::dvec3(directions.x[i], directions.y[i], directions.z[i]));
    texels.x[i] = at.x, texels.y[i] = at.y;
  }
}

TexelRows::TexelRows(ProbeLayout layout, int width, int height) : layout_(layout), width_(width), height_(height) {
  if (layout != ProbeLayout::latlong) return;
  for (int x = 0; x < width; ++x) {
    const double longitude = (0.5 - x / (width - 1.0)) * 2 * kPi;
    sin_longitude_.push_back(std::sin(longitude)), cos_longitude_.push_back(std::cos(longitude));
  }
  for (int y = 0; y < height; ++y) {
    const double latitude = (0.5 - y / (height - 1.0)) * kPi;
    sin_latitude_.push_back(std::sin(latitude)), cos_latitude_.push_back(std::cos(latitude));
    outer_column_sr_.push_back(texel_solid_angle(layout, width, height, 0, y));
    inner_column_sr_.push_back(texel_solid_angle(layout, width, height, 1, y));
  }
}

}  // namespace catchlight::render
