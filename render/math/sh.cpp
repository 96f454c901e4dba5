#include "render/math/sh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace catchlight::render {
namespace {

constexpr double kPi = std::numbers::pi;

// Factors of the recurrences for the normalised associated Legendre functions with sin^m taken out:
//   N(m,m) = diagonal[m] N(m-1,m-1),   N(l,m) = a (z N(l-1,m) - b N(l-2,m)).
// Normalising before, not after, the recurrence keeps every value near 1: no factorials, no cancellation.
template <typename Real>
struct LegendreFactors {
  std::array<Real, kMaxShBands> diagonal{};
  std::array<std::array<Real, kMaxShBands>, kMaxShBands> a{}, b{};

  LegendreFactors() {
    for (int m = 1; m < kMaxShBands; ++m) diagonal[m] = static_cast<Real>(std::sqrt((2.0 * m + 1) / (2.0 * m)));
    for (int l = 1; l < kMaxShBands; ++l) {
      for (int m = 0; m < l; ++m) {
        a[l][m] = static_cast<Real>(std::sqrt((4.0 * l * l - 1) / (1.0 * l * l - m * m)));
        if (l - 1 > m) b[l][m] = static_cast<Real>(std::sqrt(((l - 1.0) * (l - 1) - m * m) / (4.0 * (l - 1) * (l - 1) - 1)));
      }
    }
  }
};

template <typename Real>
void evaluate(const glm::dvec3& direction, int bands, std::span<Real> out) {
  static const LegendreFactors<double> factors;
  if (bands < 1 || bands > kMaxShBands || out.size() != static_cast<std::size_t>(sh_count(bands))) {
    throw std::invalid_argument("evaluate_sh: " + std::to_string(bands) + " bands into " + std::to_string(out.size()) +
                                " values");
  }
  double diagonal = std::sqrt(1.0 / (4.0 * kPi));
  double cos_part = 1.0, sin_part = 0.0;  // Re, Im of (x + iy)^m = sin^m(theta) e^(i m phi)
  for (int m = 0; m < bands; ++m) {
    double before = 0.0, legendre = diagonal;
    for (int l = m; l < bands; ++l) {
      if (m == 0) {
        out[sh_index(l, 0)] = static_cast<Real>(legendre);
      } else {
        out[sh_index(l, m)] = static_cast<Real>(std::numbers::sqrt2 * legendre * cos_part);
        out[sh_index(l, -m)] = static_cast<Real>(std::numbers::sqrt2 * legendre * sin_part);
      }
      if (l + 1 < bands) {
        const double next = factors.a[l + 1][m] * (direction.z * legendre - factors.b[l + 1][m] * before);
        before = std::exchange(legendre, next);
      }
    }
    if (m + 1 < bands) diagonal *= factors.diagonal[m + 1];
    const double cos_next = direction.x * cos_part - direction.y * sin_part;
    sin_part = direction.x * sin_part + direction.y * cos_part;
    cos_part = cos_next;
  }
}

/// Directions that go through the recurrences side by side.
constexpr int kLanes = 8;
using Lanes [[gnu::vector_size(kLanes * sizeof(float))]] = float;

// The recurrences of evaluate(), lane by lane; the weight is taken along in the Legendre functions.
[[gnu::target_clones("avx2", "default")]] void add_lanes(const std::array<Lanes, 4>& batch, int bands,
                                                         const LegendreFactors<float>& factors, Lanes* sums) {
  const Lanes x = batch[0], y = batch[1], z = batch[2], weight = batch[3];
  Lanes diagonal = weight * (std::numbers::inv_sqrtpi_v<float> / 2), cos_part = x * 0 + 1, sin_part = x * 0;
  for (int m = 0; m < bands; ++m) {
    Lanes before = x * 0, legendre = diagonal;
    for (int l = m;; ++l) {
      sums[sh_index(l, m)] += legendre * cos_part;
      if (m > 0) sums[sh_index(l, -m)] += legendre * sin_part;
      if (l + 1 == bands) break;
      const Lanes next = factors.a[l + 1][m] * (z * legendre - factors.b[l + 1][m] * before);
      before = legendre, legendre = next;
    }
    if (m + 1 == bands) break;
    diagonal *= factors.diagonal[m + 1] * (m == 0 ? std::numbers::sqrt2_v<float> : 1.0f);
    const Lanes cos_next = x * cos_part - y * sin_part;
    sin_part = x * sin_part + y * cos_part;
    cos_part = cos_next;
  }
}

int bands_of(const ShRgb& coefficients) {
  const int bands = static_cast<int>(std::lround(std::sqrt(static_cast<double>(coefficients.size()))));
  if (bands < 1 || bands > kMaxShBands || sh_count(bands) != static_cast<int>(coefficients.size())) {
    throw std::invalid_argument("spherical harmonics: " + std::to_string(coefficients.size()) +
                                " coefficients are no whole number of bands");
  }
  return bands;
}

struct Node {
  double position, weight;
};

// Gauss-Legendre nodes on [-1, 1] by Newton's method on the Legendre polynomial; exact to degree 2 count - 1.
std::vector<Node> gauss_legendre(int count) {
  std::vector<Node> nodes(count);
  for (int i = 0; i < count; ++i) {
    double x = std::cos(kPi * (i + 0.75) / (count + 0.5)), slope = 1.0;
    for (int step = 0; step < 8; ++step) {  // quadratic convergence from an already close start: 4 would do
      double before = 1.0, value = x;
      for (int l = 2; l <= count; ++l) before = std::exchange(value, ((2 * l - 1) * x * value - (l - 1) * before) / l);
      slope = count * (x * value - before) / (x * x - 1);
      x -= value / slope;
    }
    nodes[i] = {x, 2 / ((1 - x * x) * slope * slope)};
  }
  return nodes;
}

}  // namespace

void evaluate_sh(const glm::dvec3& direction, int bands, std::span<float> out) {
  evaluate(direction, bands, out);
}

void evaluate_sh(const glm::dvec3& direction, int bands, std::span<double> out) {
  evaluate(direction, bands, out);
}

void add_sh(std::span<const float> x, std::span<const float> y, std::span<const float> z, std::span<const float> weight,
            int bands, std::span<float> sums) {
  static const LegendreFactors<float> factors;
  std::array<Lanes, kMaxShBands * kMaxShBands> lane_sums;
  std::memset(lane_sums.data(), 0, sums.size() * sizeof(Lanes));
  for (std::size_t first = 0; first < x.size(); first += kLanes) {
    std::array<Lanes, 4> batch{};  // lanes that are left over weigh nothing
    const std::size_t bytes = std::min<std::size_t>(kLanes, x.size() - first) * sizeof(float);
    std::memcpy(&batch[0], &x[first], bytes);
    std::memcpy(&batch[1], &y[first], bytes);
    std::memcpy(&batch[2], &z[first], bytes);
    std::memcpy(&batch[3], &weight[first], bytes);
    add_lanes(batch, bands, factors, lane_sums.data());
  }
  for (std::size_t i = 0; i < sums.size(); ++i)
    for (int k = 0; k < kLanes; ++k) sums[i] += lane_sums[i][k];
}

ShRgb rotate_sh(const ShRgb& coefficients, const glm::dmat3& rotation) {
  // Projects the rotated function by a quadrature that is exact for it: products of two functions of n bands are polynomials
  // of degree 2n - 2, which n Gauss nodes in z and 2n - 1 equal steps of azimuth integrate without error.
  const int bands = bands_of(coefficients), azimuths = 2 * bands - 1;
  const glm::dmat3 inverse_rotation = glm::transpose(rotation);
  std::vector<double> basis(sh_count(bands));
  std::vector<glm::dvec3> rotated(coefficients.size(), glm::dvec3(0));
  for (const Node& node : gauss_legendre(bands)) {
    const double radius = std::sqrt(std::max(0.0, 1 - node.position * node.position));
    for (int k = 0; k < azimuths; ++k) {
      const double phi = 2 * kPi * k / azimuths;
      const glm::dvec3 direction(radius * std::cos(phi), radius * std::sin(phi), node.position);
      evaluate_sh(inverse_rotation * direction, bands, basis);
      glm::dvec3 value(0);
      for (std::size_t i = 0; i < basis.size(); ++i) value += basis[i] * glm::dvec3(coefficients[i]);
      evaluate_sh(direction, bands, basis);
      for (std::size_t i = 0; i < basis.size(); ++i) rotated[i] += (node.weight * 2 * kPi / azimuths * basis[i]) * value;
    }
  }
  return {rotated.begin(), rotated.end()};
}

glm::dvec3 irradiance_over_pi(const ShRgb& radiance, const glm::dvec3& normal) {
  const int bands = bands_of(radiance);
  std::vector<double> basis(sh_count(bands));
  evaluate_sh(normal, bands, basis);
  glm::dvec3 sum(0);
  for (int l = 0; l < bands; ++l) {
    for (int m = -l; m <= l; ++m) sum += cosine_lobe_over_pi(l) * basis[sh_index(l, m)] * glm::dvec3(radiance[sh_index(l, m)]);
  }
  return sum;
}

double cosine_lobe_over_pi(int l) {
  if (l == 0) return 1.0;
  if (l == 1) return 2.0 / 3.0;
  if (l % 2 != 0) return 0.0;
  // Ramamoorthi & Hanrahan 2001, eq. 8: 2 (-1)^(l/2 - 1) / ((l + 2)(l - 1)) * l! / (2^l (l/2)!^2), the last factor as a product.
  double central = 1.0;
  for (int k = 1; k <= l / 2; ++k) central *= (2.0 * k - 1) / (2.0 * k);
  return (l / 2 % 2 == 1 ? 2.0 : -2.0) / ((l + 2.0) * (l - 1.0)) * central;
}

}  // namespace catchlight::render
