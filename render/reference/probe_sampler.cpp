#include "render/reference/probe_sampler.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "catchlight/color.hpp"
#include "catchlight/util/parallel.hpp"

namespace catchlight::render::reference {
namespace {

constexpr double kPi = std::numbers::pi;

double luminance(const glm::dvec3& light) {
  return glm::dot(kLuminanceWeights, light);
}

// A point of [0, 1] with density proportional to a + (b - a) x.
double sample_linear(double u, double a, double b) {
  return a + b > 0 ? std::min(u * (a + b) / std::max(a + std::sqrt((1 - u) * a * a + u * b * b), 1e-300), 1.0) : u;
}

// The interval of `cdf` that holds u, which becomes the place within the interval.
template <typename Number>
int choose(const Number* cdf, int intervals, double& u) {
  const Number* after = std::upper_bound(cdf, cdf + intervals + 1, u, [](double value, Number edge) { return value < edge; });
  int i = std::clamp(static_cast<int>(after - cdf) - 1, 0, intervals - 1);
  while (i > 0 && cdf[i + 1] == cdf[i]) --i;  // u rounded up to 1 behind the last interval that holds anything
  const double low = cdf[i], high = cdf[i + 1];
  u = high > low ? std::clamp((u - low) / (high - low), 0.0, 1.0) : 0.5;
  return i;
}

}  // namespace

ProbeSampler::ProbeSampler(const Probe& probe, const glm::dmat3& tag_from_probe, bool only_above)
    : image_(convert(probe, ProbeLayout::latlong).image), tag_from_probe_(tag_from_probe) {
  std::vector<double> row_weight(rows());
  cell_cdf_.resize(static_cast<std::size_t>(rows()) * (columns() + 1));
  parallel_for(rows(), 0, [&](std::size_t y) {
    std::vector<double> sum(columns() + 1, 0.0);
    for (int x = 0; x < columns(); ++x) sum[x + 1] = sum[x] + cell_weight(x, static_cast<int>(y), only_above);
    row_weight[y] = sum.back();
    float* cdf = &cell_cdf_[y * (columns() + 1)];
    for (int x = 0; x <= columns(); ++x) cdf[x] = static_cast<float>(sum[x] / std::max(sum.back(), 1e-300));
  });
  row_cdf_.assign(1, 0.0);
  for (const double weight : row_weight) row_cdf_.push_back(row_cdf_.back() + weight);
  const double total = row_cdf_.back();
  if (total > 0) {
    for (double& edge : row_cdf_) edge /= total;
  } else {
    row_cdf_.clear();
  }
}

glm::dvec3 ProbeSampler::texel(int x, int y) const {
  const float* value = image_.pixel(x, y);
  return {value[0], value[1], value[2]};
}

double ProbeSampler::cell_weight(int x, int y, bool only_above) const {
  const auto sin_of_row = [&](int row) { return std::sin((0.5 - static_cast<double>(row) / rows()) * kPi); };
  double mean = 0;
  bool is_above = !only_above;
  for (const auto& [dx, dy] : {std::array{0, 0}, std::array{1, 0}, std::array{0, 1}, std::array{1, 1}}) {
    mean += luminance(texel(x + dx, y + dy)) / 4;
    is_above = is_above || direction_of({x, y, double(dx), double(dy), 0}).z > 0;
  }
  return is_above ? mean * (sin_of_row(y) - sin_of_row(y + 1)) : 0.0;
}

// ImfEnvmap.h: longitude +180 degrees in the first column's centres to -180 in the last's, 0 = +z, +90 = +x; latitude +90 = +y in
// the first row's.
ProbeSampler::Cell ProbeSampler::cell_of(const glm::dvec3& direction_tag) const {
  const glm::dvec3 d = direction_tag * tag_from_probe_;  // the inverse rotation
  const double level = std::hypot(d.x, d.z);
  const double u = (0.5 - std::atan2(d.x, d.z) / (2 * kPi)) * columns(), v = (0.5 - std::atan2(d.y, level) / kPi) * rows();
  const int x = std::clamp(static_cast<int>(u), 0, columns() - 1), y = std::clamp(static_cast<int>(v), 0, rows() - 1);
  return {x, y, u - x, v - y, level / glm::length(d)};
}

glm::dvec3 ProbeSampler::direction_of(const Cell& cell) const {
  const double longitude = (0.5 - (cell.x + cell.s) / columns()) * 2 * kPi, latitude = (0.5 - (cell.y + cell.t) / rows()) * kPi;
  const double level = std::cos(latitude);
  return tag_from_probe_ * glm::dvec3(std::sin(longitude) * level, std::sin(latitude), std::cos(longitude) * level);
}

glm::dvec3 ProbeSampler::radiance_in(const Cell& cell) const {
  const auto along = [&](int y) { return glm::mix(texel(cell.x, y), texel(cell.x + 1, y), cell.s); };
  return glm::mix(along(cell.y), along(cell.y + 1), cell.t);
}

// Probability of the cell, times the density within its square, by the square's solid angle there.
double ProbeSampler::density_in(const Cell& cell) const {
  if (row_cdf_.empty() || !(cell.cos_lat > 0)) return 0;
  const float* cdf = row_of_cells(cell.y);
  const double chosen = (row_cdf_[cell.y + 1] - row_cdf_[cell.y]) * (double{cdf[cell.x + 1]} - double{cdf[cell.x]});
  if (!(chosen > 0)) return 0;
  double mean = 0;
  for (int i = 0; i < 4; ++i) mean += luminance(texel(cell.x + i % 2, cell.y + i / 2)) / 4;
  const double in_square = luminance(radiance_in(cell)) / mean;
  return chosen * in_square / (2 * kPi / columns() * kPi / rows() * cell.cos_lat);
}

glm::dvec3 ProbeSampler::radiance(const glm::dvec3& direction_tag) const {
  return radiance_in(cell_of(direction_tag));
}

double ProbeSampler::density(const glm::dvec3& direction_tag) const {
  return density_in(cell_of(direction_tag));
}

std::optional<LightSample> ProbeSampler::sample(const glm::dvec2& square) const {
  if (row_cdf_.empty()) return std::nullopt;
  double u = square.x, v = square.y;
  Cell cell{};
  cell.y = choose(row_cdf_.data(), rows(), v);
  cell.x = choose(row_of_cells(cell.y), columns(), u);
  const auto corner = [&](int dx, int dy) { return luminance(texel(cell.x + dx, cell.y + dy)); };
  cell.t = sample_linear(v, corner(0, 0) + corner(1, 0), corner(0, 1) + corner(1, 1));
  cell.s = sample_linear(u, glm::mix(corner(0, 0), corner(0, 1), cell.t), glm::mix(corner(1, 0), corner(1, 1), cell.t));
  cell.cos_lat = std::cos((0.5 - (cell.y + cell.t) / rows()) * kPi);
  const double density = density_in(cell);
  if (!(density > 0)) return std::nullopt;
  return LightSample{direction_of(cell), radiance_in(cell), density};
}

// The quadrature is Gauss-Legendre, three nodes each way in every cell.
glm::dvec3 ProbeSampler::irradiance(const glm::dvec3& normal_tag) const {
  constexpr std::array<double, 3> kNodes{0.1127016653792583, 0.5, 0.8872983346207417}, kWeights{5.0 / 18, 8.0 / 18, 5.0 / 18};
  const double cell_size = 2 * kPi / columns() * kPi / rows();
  std::vector<glm::dvec3> sums(rows(), glm::dvec3(0));
  parallel_for(rows(), 0, [&](std::size_t row) {
    for (int i = 0; i < columns() * 9; ++i) {
      const int s = i % 3, t = i / 3 % 3;
      const Cell cell{i / 9, static_cast<int>(row), kNodes[s], kNodes[t], 0};
      const double facing = glm::dot(direction_of(cell), normal_tag);
      if (facing <= 0) continue;
      const double cos_lat = std::cos((0.5 - (cell.y + cell.t) / rows()) * kPi);
      sums[row] += kWeights[s] * kWeights[t] * cell_size * cos_lat * facing * radiance_in(cell);
    }
  });
  glm::dvec3 total(0);
  for (const glm::dvec3& sum : sums) total += sum;
  return total;
}

}  // namespace catchlight::render::reference
