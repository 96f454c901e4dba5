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

/// Adds the corner at standardised distances `at`, by its mixed difference.
void add_corner(const glm::dvec2& at, const Normal& at_u, const Normal& at_v, const Covariance2& blur, const glm::dvec2& sigma,
                double step, PatternSample& sample) {
  const double rho = std::clamp(blur.xy / (sigma.x * sigma.y), -0.999, 0.999), root = std::sqrt(1 - rho * rho);
  const double a = at.x, b = at.y, density_a = at_u.density, density_b = at_v.density;
  const Normal b_given_a = normal((b - rho * a) / root);
  const double a_given_b = normal((a - rho * b) / root).cumulative;
  const double joint = density_a * b_given_a.density / root;
  sample.white += step * bivariate_cumulative(a, at_u, b, at_v, rho);
  sample.gradient.x += step * density_a * b_given_a.cumulative / sigma.x;
  sample.gradient.y += step * density_b * a_given_b / sigma.y;
  sample.uu -= step * (a * density_a * b_given_a.cumulative + rho * joint) / blur.xx;
  sample.vv -= step * (b * density_b * a_given_b + rho * joint) / blur.yy;
  sample.uv += step * joint / (sigma.x * sigma.y);
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
  constexpr double kFar = 1e6, kHalfCell = 0.5 / kReachSigmas;
  if (!(std::abs(cell.x) < kFar && std::abs(cell.y) < kFar)) return {};
  const glm::dvec2 sigma(std::sqrt(blur.xx), std::sqrt(blur.yy));
  if (sigma.x < kHalfCell && sigma.y < kHalfCell) return sample_near_one_corner(cell, blur, sigma);
  return sample_near_many(cell, blur);
}

/// White as white() has it: the outermost cells are the paper that goes on beyond.
double TagPattern::clamped(int column, int row) const {
  const int x = std::clamp(column + margin_ + kPaperCells, 0, side_ - 1),
            y = std::clamp(row + margin_ + kPaperCells, 0, side_ - 1);
  return static_cast<double>(white_[static_cast<std::size_t>(y * side_ + x)]);
}

/// The usual case, of cells wider than the blur reaches: the corner that is nearest is all there can be. Lines out of reach
/// separate a cell from itself.
PatternSample TagPattern::sample_near_one_corner(const glm::dvec2& cell, const Covariance2& blur, const glm::dvec2& sigma) const {
  const glm::ivec2 inside(floor_of(cell.x), floor_of(cell.y)), nearest(floor_of(cell.x + 0.5), floor_of(cell.y + 0.5));
  const double a = (cell.x - nearest.x) / sigma.x, b = (cell.y - nearest.y) / sigma.y;
  const bool has_column = std::abs(a) <= kReachSigmas, has_row = std::abs(b) <= kReachSigmas;
  const int left = has_column ? nearest.x - 1 : inside.x, right = has_column ? nearest.x : inside.x;
  const int top = has_row ? nearest.y - 1 : inside.y, bottom = has_row ? nearest.y : inside.y;
  const double white = clamped(left, top), right_of = clamped(right, top), below = clamped(left, bottom),
               across = clamped(right, bottom);
  PatternSample result;
  if (std::min({white, right_of, below, across}) < 0) return result;
  const double step_u = right_of - white, step_v = below - white, corner = (across - below) - step_u;
  result.known = true;
  result.white = white;
  if (step_u == 0 && step_v == 0 && corner == 0) return result;
  result.edge = true;
  const Normal at_a = normal(a), at_b = normal(b);
  result.white += step_u * at_a.cumulative + step_v * at_b.cumulative;
  result.gradient = {step_u * at_a.density / sigma.x, step_v * at_b.density / sigma.y};
  result.uu = -step_u * a * at_a.density / blur.xx;
  result.vv = -step_v * b * at_b.density / blur.yy;
  if (corner != 0) add_corner({a, b}, at_a, at_b, blur, sigma, corner, result);
  return result;
}

PatternSample TagPattern::sample_near_many(const glm::dvec2& cell, const Covariance2& blur) const {
  PatternSample result;
  const Lines columns(cell.x, blur.xx), rows(cell.y, blur.yy);
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

  for (int j = 0; j < rows.count; ++j)
    for (int i = 0; i < columns.count; ++i) {
      const double step = (cells[j + 1][i + 1] - cells[j + 1][i]) - (cells[j][i + 1] - cells[j][i]);
      if (step == 0) continue;
      result.edge = true;
      add_corner({columns.at[i], rows.at[j]}, columns.normal[i], rows.normal[j], blur, {columns.sigma, rows.sigma}, step, result);
    }
  return result;
}

}  // namespace catchlight::tracking
