// The standard normal distribution, tabulated: refinement asks for it millions of times a second.
#pragma once

namespace catchlight::tracking {

struct Normal {
  double density;     ///< φ(x)
  double cumulative;  ///< Φ(x)
};

/// Density and cumulative probability at x, within 1e-6 of the closed form.
Normal normal(double x);

/// Probability that X < a and Y < b for standard normal X and Y of correlation `rho`, within 1e-6 up to |rho| = 0.95; `at_a` and
/// `at_b` are normal(a) and normal(b). Small correlations by Mehler's series in Hermite polynomials, others by Plackett's
/// identity integrated over asin(rho), as Drezner and Wesolowsky (1990) do.
double bivariate_cumulative(double a, const Normal& at_a, double b, const Normal& at_b, double rho);

}  // namespace catchlight::tracking
