#include "tracking/refinement/normal_distribution.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace catchlight::tracking {
namespace {

/// Gauss-Legendre nodes on [-1, 1]; each stands for its negative, too.
struct GaussNode {
  double at, weight;
};

constexpr GaussNode kTwelvePoints[] = {{0.981560634246719, 0.047175336386512}, {0.904117256370475, 0.106939325995318},
                                       {0.769902674194305, 0.160078328543346}, {0.587317954286617, 0.203167426723066},
                                       {0.367831498998180, 0.233492536538355}, {0.125233408511469, 0.249147045813403}};

constexpr double kSeriesReach = 0.35;  ///< what is left out is under 5e-7
constexpr int kSeriesTerms = 8;

/// sum of rho^n / n! He(n-1, a) He(n-1, b)
double mehler_series(double a, double b, double rho) {
  double at_a = 1, before_a = 0, at_b = 1, before_b = 0, factor = rho, sum = rho;
  for (int n = 2; n <= kSeriesTerms; ++n) {
    const double next_a = a * at_a - (n - 2) * before_a, next_b = b * at_b - (n - 2) * before_b;
    before_a = at_a, before_b = at_b, at_a = next_a, at_b = next_b;
    factor *= rho / n;
    sum += factor * at_a * at_b;
  }
  return sum;
}

double plackett_integral(double a, double b, double rho) {
  const double half_angle = std::asin(rho) / 2, squares = (a * a + b * b) / 2, product = a * b;
  double integral = 0;
  for (const GaussNode& node : kTwelvePoints)
    for (const double at : {1 + node.at, 1 - node.at}) {
      const double sine = std::sin(half_angle * at);
      integral += node.weight * std::exp((product * sine - squares) / std::max(1 - sine * sine, 1e-12));
    }
  return integral * half_angle / (2 * std::numbers::pi);
}

}  // namespace

const decltype(kNormals) kNormals = [] {
  std::remove_const_t<decltype(kNormals)> made;
  for (std::size_t i = 0; i < made.size(); ++i) {
    const double x = static_cast<double>(i) * kNormalStep - kNormalReach;
    made[i] = {std::exp(-x * x / 2) / std::sqrt(2 * std::numbers::pi), std::erfc(-x / std::numbers::sqrt2) / 2};
  }
  return made;
}();

double bivariate_cumulative(double a, const Normal& at_a, double b, const Normal& at_b, double rho) {
  const double independent = at_a.cumulative * at_b.cumulative;
  if (std::abs(rho) < kSeriesReach) return independent + at_a.density * at_b.density * mehler_series(a, b, rho);
  return independent + plackett_integral(a, b, rho);
}

}  // namespace catchlight::tracking
