// A probe's light as a whole: sums over all its texels.
#include <algorithm>
#include <vector>

#include "catchlight/util/parallel.hpp"
#include "render/probe/probe.hpp"

namespace catchlight::render {
namespace {

// Sum over the image of add(sum, direction, radiance * solid angle), in an order that does not depend on the threads.
template <typename Sum, typename Add>
Sum sum_over_texels(const Probe& probe, const Sum& zero, const Add& add) {
  const int width = probe.image.width, height = probe.image.height;
  std::vector<Sum> rows(height, zero);
  parallel_for(height, 0, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      const auto direction = direction_from_texel(probe.layout, width, height, x, y);
      if (!direction) continue;
      const float* radiance = probe.image.pixel(x, y);
      const double solid_angle = texel_solid_angle(probe.layout, width, height, x, y);
      add(rows[row], *direction, solid_angle * glm::dvec3(radiance[0], radiance[1], radiance[2]));
    }
  });
  Sum total = zero;
  for (const Sum& row : rows) {
    for (std::size_t i = 0; i < total.size(); ++i) total[i] += row[i];
  }
  return total;
}

}  // namespace

ShRgb project_to_sh(const Probe& probe, int bands) {
  const std::vector<glm::dvec3> zero(sh_count(bands), glm::dvec3(0));
  const auto sum = sum_over_texels(probe, zero, [bands](auto& row, const glm::dvec3& direction, const glm::dvec3& light) {
    double basis[kMaxShBands * kMaxShBands];
    evaluate_sh(direction, bands, std::span<double>(basis, row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) row[i] += basis[i] * light;
  });
  return {sum.begin(), sum.end()};
}

glm::dvec3 irradiance(const Probe& probe, const glm::dvec3& normal_probe) {
  const std::vector<glm::dvec3> zero(1, glm::dvec3(0));
  return sum_over_texels(probe, zero, [&](auto& row, const glm::dvec3& direction, const glm::dvec3& light) {
    row[0] += std::max(0.0, glm::dot(direction, normal_probe)) * light;
  })[0];
}

}  // namespace catchlight::render
