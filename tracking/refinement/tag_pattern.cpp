#include "tracking/refinement/tag_pattern.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tracking/refinement/normal_distribution.hpp"

namespace catchlight::tracking {
namespace {

constexpr int kPaperCells = 3;        ///< white around the print, as far as any blur reaches
constexpr double kReachSigmas = 3.5;  ///< what lies beyond adds less than 3e-4
constexpr int kMaxLines = 16;         ///< within reach along one axis; a blur that wide leaves nothing to see

/// std::floor without a library call, which is most of what a plateau costs.
int floor_of(double x) {
  const int whole = static_cast<int>(x);
  return whole - (x < whole);
}

/// The grid lines of one axis that are within reach.
struct Lines {
  double variance, sigma;
  int first, count;
  double at[kMaxLines];  ///< standardised distances
  Normal normal[kMaxLines];

  Lines(double place, double blur) : variance(blur), sigma(std::sqrt(blur)) {
    const double reach = kReachSigmas * sigma;
    first = -floor_of(reach - place);
    count = std::clamp(floor_of(place + reach) - first + 1, 0, kMaxLines);
    for (int i = 0; i < count; ++i) {
      at[i] = (place - (first + i)) / sigma;
      normal[i] = tracking::normal(at[i]);
    }
  }
};

/// Adds the edges that lie on one axis's lines, from the cells along it, `stride` apart.
void add_straight_edges(const Lines& lines, const float* cells, int stride, PatternSample& sample, double& slope,
                        double& curvature) {
  for (int i = 0; i < lines.count; ++i) {
    const double step = cells[(i + 1) * stride] - cells[i * stride];
    if (step == 0) continue;
    sample.edge = true;
    const double density = lines.normal[i].density;
    sample.white += step * lines.normal[i].cumulative;
    slope += step * density / lines.sigma;
    curvature -= step * lines.at[i] * density / lines.variance;
  }
}

}  // namespace

TagPattern::TagPattern(const TagLayout& layout)
    : cells_across_(layout.cells_across), margin_(layout.margin), side_(layout.side() + 2 * kPaperCells) {
  white_.assign(static_cast<std::size_t>(side_ * side_), 1.0f);
  for (int row = -margin_; row < cells_across_ + margin_; ++row)
    for (int column = -margin_; column < cells_across_ + margin_; ++column) {
      const Ink ink = layout.at(column, row);
      const int place = (row + margin_ + kPaperCells) * side_ + column + margin_ + kPaperCells;
      white_[static_cast<std::size_t>(place)] = ink == Ink::unknown ? -1.0f : ink == Ink::white ? 1.0f : 0.0f;
    }
}

float TagPattern::white(int column, int row) const {
  const int x = column + margin_ + kPaperCells, y = row + margin_ + kPaperCells;
  return x < 0 || y < 0 || x >= side_ || y >= side_ ? 1.0f : white_[static_cast<std::size_t>(y * side_ + x)];
}

TagPattern::Neighbourhood TagPattern::around(const glm::dvec2& cell, const glm::dvec2& reach) const {
  const glm::ivec2 from(floor_of(cell.x - reach.x), floor_of(cell.y - reach.y));
  const glm::ivec2 to(floor_of(cell.x + reach.x), floor_of(cell.y + reach.y));
  const float first = white(from.x, from.y);
  Neighbourhood result = Neighbourhood::plateau;
  for (int row = from.y; row <= to.y; ++row)
    for (int column = from.x; column <= to.x; ++column) {
      const float value = white(column, row);
      if (value < 0) return Neighbourhood::unknown;
      if (value != first) result = Neighbourhood::edge;
    }
  return result;
}

PatternSample TagPattern::sample(const glm::dvec2& cell, const Covariance2& blur) const {
  constexpr double kFar = 1e6;
  PatternSample result;
  if (!(std::abs(cell.x) < kFar && std::abs(cell.y) < kFar)) return result;
  const Lines columns(cell.x, blur.xx), rows(cell.y, blur.yy);
  const double sigma_u = columns.sigma, sigma_v = rows.sigma;
  float cells[kMaxLines + 1][kMaxLines + 1];
  for (int j = 0; j <= rows.count; ++j)
    for (int i = 0; i <= columns.count; ++i) {
      cells[j][i] = white(columns.first - 1 + i, rows.first - 1 + j);
      if (cells[j][i] < 0) return result;
    }
  result.known = true;
  result.white = white(columns.first - 1, rows.first - 1);
  add_straight_edges(columns, &cells[0][0], 1, result, result.gradient.x, result.uu);
  add_straight_edges(rows, &cells[0][0], kMaxLines + 1, result, result.gradient.y, result.vv);
  if (columns.count == 0 || rows.count == 0) return result;

  const double rho = std::clamp(blur.xy / (sigma_u * sigma_v), -0.999, 0.999), root = std::sqrt(1 - rho * rho);
  for (int j = 0; j < rows.count; ++j)
    for (int i = 0; i < columns.count; ++i) {
      const double step = (cells[j + 1][i + 1] - cells[j + 1][i]) - (cells[j][i + 1] - cells[j][i]);
      if (step == 0) continue;
      result.edge = true;
      const double a = columns.at[i], b = rows.at[j];
      const double density_a = columns.normal[i].density, density_b = rows.normal[j].density;
      const Normal b_given_a = normal((b - rho * a) / root);
      const double a_given_b = normal((a - rho * b) / root).cumulative;
      const double joint = density_a * b_given_a.density / root;
      result.white += step * bivariate_cumulative(a, columns.normal[i], b, rows.normal[j], rho);
      result.gradient.x += step * density_a * b_given_a.cumulative / sigma_u;
      result.gradient.y += step * density_b * a_given_b / sigma_v;
      result.uu -= step * (a * density_a * b_given_a.cumulative + rho * joint) / blur.xx;
      result.vv -= step * (b * density_b * a_given_b + rho * joint) / blur.yy;
      result.uv += step * joint / (sigma_u * sigma_v);
    }
  return result;
}

}  // namespace catchlight::tracking
