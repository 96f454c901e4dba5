// The standard normal distribution, tabulated: refinement asks for it millions of times a second.
#pragma once

#include <array>
#include <cstddef>

namespace catchlight::tracking {

struct Normal {
  double density;     ///< φ(x)
  double cumulative;  ///< Φ(x)
};

inline constexpr double kNormalReach = 6, kNormalStep = 1.0 / 64;  ///< beyond the reach, nothing is left
extern const std::array<Normal, static_cast<std::size_t>(2 * kNormalReach / kNormalStep) + 1> kNormals;

/// Density and cumulative probability at x, within 1e-6 of the closed form: Taylor's series about the nearest node.
inline Normal normal(double x) {
  if (!(x > -kNormalReach)) return {0, 0};
  if (!(x < kNormalReach)) return {0, 1};
  const int i = static_cast<int>((x + kNormalReach) / kNormalStep + 0.5);
  const double at = i * kNormalStep - kNormalReach, d = x - at;
  const Normal& node = kNormals[static_cast<std::size_t>(i)];
  return {node.density * (1 - d * at + d * d / 2 * (at * at - 1)), node.cumulative + node.density * d * (1 - d * at / 2)};
}

/// Probability that X < a and Y < b for standard normal X and Y of correlation `rho`, within 1e-6 up to |rho| = 0.95; `at_a` and
/// `at_b` are normal(a) and normal(b). Small correlations by Mehler's series in Hermite polynomials, others by Plackett's
/// identity integrated over asin(rho), as Drezner and Wesolowsky (1990) do.
double bivariate_cumulative(double a, const Normal& at_a, double b, const Normal& at_b, double rho);

}  // namespace catchlight::tracking
