#include "render/math/sh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <random>

namespace catchlight::render {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kFloat = 1e-6;  // what a coefficient kept in float can hold, with a margin for sums of a hundred

std::vector<double> basis(const glm::dvec3& direction, int bands) {
  std::vector<double> values(sh_count(bands));
  evaluate_sh(direction, bands, values);
  return values;
}

glm::dvec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

glm::dmat3 random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return glm::mat3_cast(glm::normalize(glm::dquat(normal(random), normal(random), normal(random), normal(random))));
}

// Midpoint sum over a fine grid: shares nothing with the quadrature inside.
std::vector<glm::dvec3> project(const std::function<glm::dvec3(const glm::dvec3&)>& f, int bands) {
  constexpr int kRows = 400, kColumns = 400;
  std::vector<glm::dvec3> sum(sh_count(bands), glm::dvec3(0));
  for (int row = 0; row < kRows; ++row) {
    const double z = 1 - 2 * (row + 0.5) / kRows, radius = std::sqrt(1 - z * z);
    for (int column = 0; column < kColumns; ++column) {
      const double phi = 2 * kPi * (column + 0.5) / kColumns;
      const glm::dvec3 direction(radius * std::cos(phi), radius * std::sin(phi), z);
      const std::vector<double> y = basis(direction, bands);
      for (std::size_t i = 0; i < y.size(); ++i) sum[i] += y[i] * 4 * kPi / (kRows * kColumns) * f(direction);
    }
  }
  return sum;
}

ShRgb random_coefficients(int bands, std::mt19937& random) {
  std::normal_distribution<float> normal;
  ShRgb coefficients(sh_count(bands));
  for (glm::vec3& c : coefficients) c = {normal(random), normal(random), normal(random)};
  return coefficients;
}

glm::dvec3 value_of(const ShRgb& coefficients, const glm::dvec3& direction, int bands) {
  const std::vector<double> y = basis(direction, bands);
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < y.size(); ++i) sum += y[i] * glm::dvec3(coefficients[i]);
  return sum;
}

// Closed forms, as in Sloan 2008 appendix A2 (which has the phase with the opposite sign for odd m).
TEST(ShBasis, MatchesClosedFormsOfTheFirstFourBands) {
  std::mt19937 random(1);
  for (int k = 0; k < 50; ++k) {
    const glm::dvec3 d = random_direction(random);
    const double x = d.x, y = d.y, z = d.z;
    const std::vector<double> expected{
        std::sqrt(1 / kPi) / 2,
        std::sqrt(3 / (4 * kPi)) * y,
        std::sqrt(3 / (4 * kPi)) * z,
        std::sqrt(3 / (4 * kPi)) * x,
        std::sqrt(15 / kPi) / 2 * x * y,
        std::sqrt(15 / kPi) / 2 * y * z,
        std::sqrt(5 / kPi) / 4 * (3 * z * z - 1),
        std::sqrt(15 / kPi) / 2 * x * z,
        std::sqrt(15 / kPi) / 4 * (x * x - y * y),
        std::sqrt(35 / (2 * kPi)) / 4 * y * (3 * x * x - y * y),
        std::sqrt(105 / kPi) / 2 * x * y * z,
        std::sqrt(21 / (2 * kPi)) / 4 * y * (5 * z * z - 1),
        std::sqrt(7 / kPi) / 4 * z * (5 * z * z - 3),
        std::sqrt(21 / (2 * kPi)) / 4 * x * (5 * z * z - 1),
        std::sqrt(105 / kPi) / 4 * z * (x * x - y * y),
        std::sqrt(35 / (2 * kPi)) / 4 * x * (x * x - 3 * y * y),
    };
    const std::vector<double> actual = basis(d, 4);
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(actual[i], expected[i], 1e-14) << "i = " << i;
  }
}

TEST(ShBasis, HasTheStatedSigns) {
  EXPECT_GT(basis({0, 1, 0}, 2)[sh_index(1, -1)], 0.48);
  EXPECT_GT(basis({0, 0, 1}, 2)[sh_index(1, 0)], 0.48);
  EXPECT_GT(basis({1, 0, 0}, 2)[sh_index(1, 1)], 0.48);
}

TEST(ShBasis, IsOrthonormalInAllTenBands) {
  constexpr int kCount = sh_count(kMaxShBands);
  std::vector<double> products(kCount * kCount);
  constexpr int kRows = 3000, kColumns = 2 * kMaxShBands;  // equal steps of azimuth are exact for degree < kColumns
  for (int row = 0; row < kRows; ++row) {
    const double z = 1 - 2 * (row + 0.5) / kRows, radius = std::sqrt(1 - z * z);
    for (int column = 0; column < kColumns; ++column) {
      const double phi = 2 * kPi * column / kColumns;
      const std::vector<double> y = basis({radius * std::cos(phi), radius * std::sin(phi), z}, kMaxShBands);
      for (int i = 0; i < kCount; ++i) {
        for (int k = 0; k <= i; ++k) products[i * kCount + k] += y[i] * y[k] * 4 * kPi / (kRows * kColumns);
      }
    }
  }
  // Midpoints in z err by h^2 / 24 times the slope's change, some hundreds for degree 18.
  for (int i = 0; i < kCount; ++i) {
    for (int k = 0; k <= i; ++k) EXPECT_NEAR(products[i * kCount + k], i == k ? 1.0 : 0.0, 5e-5) << i << ", " << k;
  }
}

TEST(ShBasis, AddsUpToTheSameInEveryDirection) {
  // Unsoeld's theorem: the squares of band l add up to (2 l + 1) / 4 pi, at the poles too.
  std::mt19937 random(2);
  for (const glm::dvec3& direction : {glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1), glm::dvec3(1, 0, 0), random_direction(random)}) {
    const std::vector<double> y = basis(direction, kMaxShBands);
    for (int l = 0; l < kMaxShBands; ++l) {
      double sum = 0;
      for (int m = -l; m <= l; ++m) sum += y[sh_index(l, m)] * y[sh_index(l, m)];
      EXPECT_NEAR(sum, (2 * l + 1) / (4 * kPi), 1e-13) << "l = " << l;
    }
  }
}

TEST(ShBasis, FloatAndDoubleAgree) {
  std::vector<float> single(sh_count(kMaxShBands));
  const glm::dvec3 direction = glm::normalize(glm::dvec3(0.3, -0.5, 0.8));
  evaluate_sh(direction, kMaxShBands, single);
  const std::vector<double> y = basis(direction, kMaxShBands);
  for (std::size_t i = 0; i < y.size(); ++i) EXPECT_FLOAT_EQ(single[i], static_cast<float>(y[i]));
}

TEST(ShBasis, RefusesWrongCounts) {
  std::vector<double> values(9);
  EXPECT_THROW(evaluate_sh({0, 0, 1}, 2, values), std::invalid_argument);
  EXPECT_THROW(evaluate_sh({0, 0, 1}, 0, values), std::invalid_argument);
  EXPECT_THROW(evaluate_sh({0, 0, 1}, kMaxShBands + 1, values), std::invalid_argument);
}

TEST(ShRotation, OfTheProjectionIsProjectionOfTheRotated) {
  const auto f = [](const glm::dvec3& d) { return glm::dvec3(std::exp(d.x), d.y * d.z, std::max(0.0, d.x + d.z)); };
  std::mt19937 random(3);
  const glm::dmat3 rotation = random_rotation(random);
  const auto plain = project(f, 6);
  const auto expected = project([&](const glm::dvec3& d) { return f(glm::transpose(rotation) * d); }, 6);
  const ShRgb rotated = rotate_sh({plain.begin(), plain.end()}, rotation);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(rotated[i][c], expected[i][c], 2e-4) << i;  // the grid's own error at the kink of max
  }
}

class ShRotationOfBands : public testing::TestWithParam<int> {};

TEST_P(ShRotationOfBands, MovesTheFunctionPointByPoint) {
  const int bands = GetParam();
  std::mt19937 random(4);
  const ShRgb coefficients = random_coefficients(bands, random);
  const glm::dmat3 rotation = random_rotation(random);
  const ShRgb rotated = rotate_sh(coefficients, rotation);
  for (int k = 0; k < 20; ++k) {
    const glm::dvec3 direction = random_direction(random);
    const glm::dvec3 before = value_of(coefficients, direction, bands), after = value_of(rotated, rotation * direction, bands);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(after[c], before[c], 20 * kFloat) << "value is a sum of up to 100 coefficients";
  }
}

TEST_P(ShRotationOfBands, KeepsTheLengthOfEachBand) {
  const int bands = GetParam();
  std::mt19937 random(5);
  const ShRgb coefficients = random_coefficients(bands, random), rotated = rotate_sh(coefficients, random_rotation(random));
  for (int l = 0; l < bands; ++l) {
    double before = 0, after = 0;
    for (int m = -l; m <= l; ++m) {
      before += coefficients[sh_index(l, m)].x * coefficients[sh_index(l, m)].x;
      after += rotated[sh_index(l, m)].x * rotated[sh_index(l, m)].x;
    }
    EXPECT_NEAR(std::sqrt(after / before), 1.0, kFloat) << "l = " << l;
  }
}

TEST_P(ShRotationOfBands, Composes) {
  const int bands = GetParam();
  std::mt19937 random(6);
  const ShRgb coefficients = random_coefficients(bands, random);
  const glm::dmat3 first = random_rotation(random), second = random_rotation(random);
  const ShRgb in_turn = rotate_sh(rotate_sh(coefficients, first), second), at_once = rotate_sh(coefficients, second * first);
  for (std::size_t i = 0; i < at_once.size(); ++i) EXPECT_NEAR(in_turn[i].y, at_once[i].y, 3 * kFloat) << i;
}

INSTANTIATE_TEST_SUITE_P(AllBands, ShRotationOfBands, testing::Range(1, kMaxShBands + 1));

TEST(ShRotation, ByNothingChangesNothing) {
  std::mt19937 random(7);
  const ShRgb coefficients = random_coefficients(kMaxShBands, random), same = rotate_sh(coefficients, glm::dmat3(1));
  for (std::size_t i = 0; i < same.size(); ++i) EXPECT_NEAR(same[i].z, coefficients[i].z, kFloat);
}

TEST(ShRotation, QuarterTurnAboutZTakesXToY) {
  ShRgb along_x(4, glm::vec3(0));
  along_x[sh_index(1, 1)] = glm::vec3(1);
  const ShRgb turned = rotate_sh(along_x, glm::dmat3(glm::dvec3(0, 1, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, 1)));
  EXPECT_NEAR(turned[sh_index(1, -1)].x, 1, kFloat);
  EXPECT_NEAR(turned[sh_index(1, 1)].x, 0, kFloat);
}

TEST(ShRotation, RefusesWhatIsNoWholeNumberOfBands) {
  EXPECT_THROW(rotate_sh(ShRgb(5), glm::dmat3(1)), std::invalid_argument);
  EXPECT_THROW(rotate_sh({}, glm::dmat3(1)), std::invalid_argument);
}

TEST(CosineLobe, HasTheValuesOfRamamoorthiAndHanrahan) {
  const double expected[] = {1, 2.0 / 3, 1.0 / 4, 0, -1.0 / 24, 0, 1.0 / 64, 0, -1.0 / 128, 0};
  for (int l = 0; l < kMaxShBands; ++l) EXPECT_NEAR(cosine_lobe_over_pi(l), expected[l], 1e-15) << "l = " << l;
}

TEST(CosineLobe, IsTheZonalProjectionOfTheClampedCosine) {
  // A_l = 2 pi integral over z of max(z, 0) P_l(z); P_l from the standard library.
  for (int l = 0; l < 16; ++l) {
    double sum = 0;
    constexpr int kSteps = 20000;
    for (int k = 0; k < kSteps; ++k) {
      const double z = (k + 0.5) / kSteps;
      sum += 2 * z * std::legendre(l, z) / kSteps;
    }
    EXPECT_NEAR(cosine_lobe_over_pi(l), sum, 1e-7) << "l = " << l;
  }
}

TEST(Irradiance, OfAConstantProbeIsItsRadiance) {
  ShRgb light(16, glm::vec3(0));
  light[0] = glm::vec3(1, 2, 3) * static_cast<float>(2 * std::sqrt(kPi));
  const glm::dvec3 radiosity = irradiance_over_pi(light, glm::normalize(glm::dvec3(1, 2, 3)));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(radiosity[c], c + 1, 3e-7 * (c + 1));
}

TEST(Irradiance, OfALinearSkyIsTwoThirdsOfItsSlope) {
  // L = z: E / pi at +z is (1/pi) integral of z^2 over the upper hemisphere = 2/3.
  ShRgb light(4, glm::vec3(0));
  light[sh_index(1, 0)] = glm::vec3(static_cast<float>(std::sqrt(4 * kPi / 3)));
  EXPECT_NEAR(irradiance_over_pi(light, {0, 0, 1}).x, 2.0 / 3, kFloat);
  EXPECT_NEAR(irradiance_over_pi(light, {0, 0, -1}).x, -2.0 / 3, kFloat);
  EXPECT_NEAR(irradiance_over_pi(light, {1, 0, 0}).x, 0, kFloat);
}

TEST(ShSums, AreTheSumsOfSingleDirections) {
  std::mt19937 random(5);
  std::normal_distribution<float> spread;
  for (const int bands : {1, 2, 7, kMaxShBands}) {
    for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{8}, std::size_t{37}}) {
      std::vector<float> x, y, z, weight, sums(sh_count(bands), 1.0f);
      std::vector<double> expected(sums.size(), 1.0), basis(sums.size());
      for (std::size_t k = 0; k < count; ++k) {
        const glm::vec3 direction = glm::normalize(glm::vec3(spread(random), spread(random), spread(random)));
        x.push_back(direction.x), y.push_back(direction.y), z.push_back(direction.z), weight.push_back(spread(random));
        evaluate_sh(direction, bands, std::span<double>(basis));
        for (std::size_t i = 0; i < basis.size(); ++i) expected[i] += weight.back() * basis[i];
      }
      add_sh(x, y, z, weight, bands, sums);
      for (std::size_t i = 0; i < sums.size(); ++i) EXPECT_NEAR(sums[i], expected[i], 2e-5) << bands << ' ' << count << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace catchlight::render
