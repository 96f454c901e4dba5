// A probe's light as a whole: sums over all its texels.
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "catchlight/util/parallel.hpp"
#include "render/probe/probe.hpp"
#include "render/probe/texel_rows.hpp"

namespace catchlight::render {
namespace {

// The row's texels that hold light: their directions, and radiance * solid angle.
struct LitRow {
  std::vector<float> x, y, z;
  std::array<std::vector<float>, 3> light;
};

LitRow lit_row(const Probe& probe, const TexelRows& texels, int y) {
  LitRow row;
  const std::array<std::vector<float>*, 6> all{&row.x, &row.y, &row.z, &row.light[0], &row.light[1], &row.light[2]};
  for (auto* values : all) values->resize(probe.image.width);
  std::size_t count = 0;
  for (int x = 0; x < probe.image.width; ++x) {
    const auto direction = texels.direction(x, y);
    if (!direction) continue;
    row.x[count] = static_cast<float>(direction->x), row.y[count] = static_cast<float>(direction->y);
    row.z[count] = static_cast<float>(direction->z);
    const auto solid_angle = static_cast<float>(texels.solid_angle(x, y));
    for (int c = 0; c < 3; ++c) row.light[c][count] = solid_angle * probe.image.pixel(x, y)[c];
    ++count;
  }
  for (auto* values : all) values->resize(count);
  return row;
}

// Sum over the image of add(sum, row), in an order that does not depend on the threads. A sum: `count` values a channel.
using Sums = std::array<std::vector<double>, 3>;

template <typename Add>
Sums sum_over_rows(const Probe& probe, std::size_t count, const Add& add) {
  const TexelRows texels(probe.layout, probe.image.width, probe.image.height);
  const std::vector<double> zero(count);
  std::vector<Sums> rows(probe.image.height, Sums{zero, zero, zero});
  parallel_for(rows.size(), 0, [&](std::size_t y) { add(rows[y], lit_row(probe, texels, static_cast<int>(y))); });
  Sums total{zero, zero, zero};
  for (const Sums& row : rows)
    for (int c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < count; ++i) total[c][i] += row[c][i];
  return total;
}

}  // namespace

ShRgb project_to_sh(const Probe& probe, int bands) {
  constexpr std::size_t kPart = 256;  // texels that are summed in single precision
  const Sums sums = sum_over_rows(probe, sh_count(bands), [&](Sums& sum, const LitRow& row) {
    for (std::size_t first = 0; first < row.x.size(); first += kPart) {
      const auto part = [&](const std::vector<float>& values) {
        return std::span(values).subspan(first, std::min(kPart, values.size() - first));
      };
      for (int c = 0; c < 3; ++c) {
        std::vector<float> part_sum(sh_count(bands));
        add_sh(part(row.x), part(row.y), part(row.z), part(row.light[c]), bands, part_sum);
        for (std::size_t i = 0; i < part_sum.size(); ++i) sum[c][i] += static_cast<double>(part_sum[i]);
      }
    }
  });
  ShRgb coefficients;
  for (std::size_t i = 0; i < sums[0].size(); ++i) coefficients.emplace_back(sums[0][i], sums[1][i], sums[2][i]);
  return coefficients;
}

glm::dvec3 irradiance(const Probe& probe, const glm::dvec3& normal_probe) {
  const Sums sums = sum_over_rows(probe, 1, [&](Sums& sum, const LitRow& row) {
    for (std::size_t i = 0; i < row.x.size(); ++i) {
      const double cosine = glm::dot(glm::dvec3(row.x[i], row.y[i], row.z[i]), normal_probe);
      for (int c = 0; c < 3; ++c) sum[c][0] += std::max(0.0, cosine) * static_cast<double>(row.light[c][i]);
    }
  });
  return {sums[0][0], sums[1][0], sums[2][0]};
}

}  // namespace catchlight::render
