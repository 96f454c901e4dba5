// The tabulated normal distribution against the closed form, the bivariate one against an integral over its density.
#include "tracking/refinement/normal_distribution.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace catchlight::tracking {
namespace {

double exact_density(double x) {
  return std::exp(-x * x / 2) / std::sqrt(2 * std::numbers::pi);
}

double exact_cumulative(double x) {
  return std::erfc(-x / std::numbers::sqrt2) / 2;
}

double bivariate(double a, double b, double rho) {
  return bivariate_cumulative(a, normal(a), b, normal(b), rho);
}

/// P(X < a, Y < b) = integral over x < a of density(x) · P(Y < b | x), by Simpson's rule.
double integrated(double a, double b, double rho) {
  constexpr int kSteps = 1200;
  const double from = -9, step = (a - from) / kSteps, root = std::sqrt(1 - rho * rho);
  double sum = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double x = from + i * step, weight = i == 0 || i == kSteps ? 1 : i % 2 ? 4 : 2;
    sum += weight * exact_density(x) * exact_cumulative((b - rho * x) / root);
  }
  return sum * step / 3;
}

/// The largest difference over a grid of limits.
double worst_error(double rho) {
  double worst = 0;
  for (double a = -4; a <= 4; a += 0.47)
    for (double b = -4; b <= 4; b += 0.53) worst = std::max(worst, std::abs(bivariate(a, b, rho) - integrated(a, b, rho)));
  return worst;
}

TEST(NormalDistribution, IsWithinAMillionthOfTheClosedForm) {
  for (double x = -7; x <= 7; x += 0.00137) {
    ASSERT_NEAR(normal(x).density, exact_density(x), 1e-6) << x;
    ASSERT_NEAR(normal(x).cumulative, exact_cumulative(x), 1e-6) << x;
  }
}

TEST(NormalDistribution, FarOutNothingIsLeft) {
  for (const double x : {6.0, 7.5, 1e300, HUGE_VAL}) {
    EXPECT_EQ(normal(x).density, 0);
    EXPECT_EQ(normal(x).cumulative, 1);
    EXPECT_EQ(normal(-x).density, 0);
    EXPECT_EQ(normal(-x).cumulative, 0);
  }
}

TEST(NormalDistribution, IsSymmetric) {
  for (double x = 0; x < 6; x += 0.0113) {
    EXPECT_NEAR(normal(x).density, normal(-x).density, 1e-12) << x;
    EXPECT_NEAR(normal(x).cumulative + normal(-x).cumulative, 1, 1e-12) << x;
  }
}

TEST(NormalDistribution, TheCumulativeNeverFalls) {
  double before = 0;
  for (double x = -6.1; x < 6.1; x += 0.0007) {
    const double here = normal(x).cumulative;
    EXPECT_GE(here, before - 1e-7) << "where one of the table's intervals ends and the next begins, " << x;
    before = here;
  }
}

TEST(BivariateNormal, IsWithinAMillionthOfTheIntegral) {
  for (const double rho : {-0.95, -0.8, -0.5, -0.41, -0.39, -0.2, 0.0, 0.1, 0.39, 0.41, 0.6, 0.9, 0.95})
    EXPECT_LT(worst_error(rho), 1e-6) << "rho = " << rho;
}

TEST(BivariateNormal, AtTheOriginItIsSheppardsAngle) {
  for (double rho = -0.95; rho <= 0.95; rho += 0.05)
    EXPECT_NEAR(bivariate(0, 0, rho), 0.25 + std::asin(rho) / (2 * std::numbers::pi), 1e-6) << rho;
}

TEST(BivariateNormal, WithoutCorrelationItIsTheProduct) {
  for (const double a : {-2.0, 0.3, 1.7})
    for (const double b : {-1.1, 0.0, 2.5}) EXPECT_NEAR(bivariate(a, b, 0), exact_cumulative(a) * exact_cumulative(b), 1e-6);
}

TEST(BivariateNormal, TheOrderOfTheTwoDoesNotMatter) {
  for (const double rho : {-0.9, -0.3, 0.3, 0.9})
    for (const double a : {-2.0, 0.3, 1.7}) EXPECT_NEAR(bivariate(a, 0.6, rho), bivariate(0.6, a, rho), 1e-14);
}

TEST(BivariateNormal, TurningTheSecondOverLeavesTheFirst) {
  // P(X < a, Y < b) + P(X < a, Y > b) = P(X < a), and -Y is correlated the other way.
  for (const double rho : {-0.95, -0.4, 0.2, 0.7})
    for (const double a : {-2.0, 0.3, 1.7})
      for (const double b : {-1.1, 0.0, 2.5})
        EXPECT_NEAR(bivariate(a, b, rho) + bivariate(a, -b, -rho), exact_cumulative(a), 1e-6);
}

TEST(BivariateNormal, NearlyPerfectCorrelationLeavesTheLesserLimit) {
  // At rho = 1 it is P(X < min(a, b)); at 0.99 still so where a and b are far apart next to sqrt(2 (1 - rho)) = 0.14.
  for (const double a : {-1.0, 0.0, 1.0})
    for (const double apart : {-1.0, -0.8, 0.8, 1.0}) {
      EXPECT_NEAR(bivariate(a, a + apart, 0.99), exact_cumulative(std::min(a, a + apart)), 1e-3) << a << " " << apart;
      const double both = exact_cumulative(a) + exact_cumulative(apart - a) - 1;
      EXPECT_NEAR(bivariate(a, apart - a, -0.99), std::max(both, 0.0), 1e-3) << a << " " << apart;
    }
}

TEST(BivariateNormal, NearlyPerfectCorrelationIsGoodEnoughForAPixel) {
  // A thousandth of the contrast is a quarter of an 8-bit code.
  for (const double rho : {-0.999, -0.99, 0.99, 0.999}) {
    EXPECT_LT(worst_error(rho), 1e-3) << "rho = " << rho;
  }
}

}  // namespace
}  // namespace catchlight::tracking
