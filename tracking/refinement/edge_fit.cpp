#include "tracking/refinement/edge_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <vector>

#include "catchlight/util/statistics.hpp"

namespace catchlight::tracking {
namespace {

constexpr int kParameters = 8;
constexpr std::size_t kMinPixels = 24;
constexpr double kTuning = 2.4;  ///< Cauchy's loss at this many standard deviations keeps 95 % efficiency on Gaussian noise
using Vector = cv::Matx<double, kParameters, 1>;
using Matrix = cv::Matx<double, kParameters, kParameters>;

/// Indices into the parameter vector.
enum { kShiftStart, kShiftEnd, kLogBlur, kMiddleStart, kMiddleEnd, kHalfStepStart, kHalfStepEnd, kSlope };

struct Modelled {
  double value;
  Vector gradient;
};

double lerp(double start, double end, double t) {
  return start + (end - start) * t;
}

/// The model of edge_fit.hpp and its derivatives by every parameter.
Modelled model(const Vector& p, const EdgePixel& pixel) {
  const double t = pixel.along, blur = std::exp(p(kLogBlur));
  const double distance = pixel.across_px - lerp(p(kShiftStart), p(kShiftEnd), t);
  const double half_step = lerp(p(kHalfStepStart), p(kHalfStepEnd), t);
  const double bright_sign = half_step >= 0 ? 1 : -1;
  const double z = distance / (std::numbers::sqrt2 * blur);
  const bool on_plateau = std::abs(z) > 4;  // where 1 − |erf| < 2e-8
  const double erf = on_plateau ? std::copysign(1.0, z) : std::erf(z);
  const double bell = on_plateau ? 0 : std::exp(-z * z) * std::numbers::inv_sqrtpi * std::numbers::sqrt2 / blur;  // erf's slope
  const double bright_share = (1 + bright_sign * erf) / 2;

  Modelled result;
  result.value = lerp(p(kMiddleStart), p(kMiddleEnd), t) + half_step * erf + p(kSlope) * distance * bright_share;
  const double by_distance = half_step * bell + p(kSlope) * (bright_share + distance * bright_sign * bell / 2);
  result.gradient(kShiftStart) = -by_distance * (1 - t);
  result.gradient(kShiftEnd) = -by_distance * t;
  result.gradient(kLogBlur) = -(half_step + p(kSlope) * distance * bright_sign / 2) * bell * distance;
  result.gradient(kMiddleStart) = 1 - t;
  result.gradient(kMiddleEnd) = t;
  result.gradient(kHalfStepStart) = erf * (1 - t);
  result.gradient(kHalfStepEnd) = erf * t;
  result.gradient(kSlope) = distance * bright_share;
  return result;
}

/// Plateaus from the outer halves of either side.
std::optional<Vector> first_guess(std::span<const EdgePixel> pixels) {
  double reach = 0;
  for (const EdgePixel& pixel : pixels) reach = std::max(reach, std::abs(pixel.across_px));
  std::vector<double> minus, plus;
  for (const EdgePixel& pixel : pixels) {
    if (pixel.across_px < -reach / 2) minus.push_back(pixel.value);
    if (pixel.across_px > reach / 2) plus.push_back(pixel.value);
  }
  if (minus.empty() || plus.empty()) return std::nullopt;
  const double low = median(std::move(minus)), high = median(std::move(plus));
  Vector p = Vector::zeros();
  p(kLogBlur) = std::log(0.7);  // a sharp camera's; the fit converges from it for blurs of 0.3 to 4 px
  p(kMiddleStart) = p(kMiddleEnd) = (low + high) / 2;
  p(kHalfStepStart) = p(kHalfStepEnd) = (high - low) / 2;
  return p;
}

/// Gaussian-consistent standard deviation from the median of |residual|.
double robust_scale(const Vector& p, std::span<const EdgePixel> pixels) {
  std::vector<double> sizes;
  sizes.reserve(pixels.size());
  for (const EdgePixel& pixel : pixels) sizes.push_back(std::abs(pixel.value - model(p, pixel).value));
  return 1.4826 * median(std::move(sizes));
}

/// Cauchy's loss: outliers (a finger, a highlight) weigh ever less, yet never zero, so that the fit can still find them good.
struct Cost {
  double scale;
  double weight(double residual) const { return 1 / (1 + square(residual)); }
  double loss(double residual) const { return std::log1p(square(residual)); }
  double square(double residual) const { return residual * residual / (scale * scale); }
};

struct Linearized {
  Matrix normal = Matrix::zeros();
  Vector right = Vector::zeros();
  double cost = 0;
};

Linearized linearize(const Vector& p, std::span<const EdgePixel> pixels, const Cost& cost) {
  Linearized result;
  for (const EdgePixel& pixel : pixels) {
    const Modelled modelled = model(p, pixel);
    const double residual = pixel.value - modelled.value, weight = cost.weight(residual);
    result.cost += cost.loss(residual);
    for (int i = 0; i < kParameters; ++i) {
      const double weighted = weight * modelled.gradient(i);
      result.right(i) += weighted * residual;
      for (int j = 0; j <= i; ++j) result.normal(i, j) += weighted * modelled.gradient(j);
    }
  }
  for (int i = 0; i < kParameters; ++i)
    for (int j = 0; j < i; ++j) result.normal(j, i) = result.normal(i, j);
  return result;
}

/// Levenberg-Marquardt until steps of the edge fall below `until_px`.
Vector minimize(Vector p, std::span<const EdgePixel> pixels, const Cost& cost, double until_px) {
  double damping = 1e-3;
  Linearized current = linearize(p, pixels, cost);
  for (int step = 0; step < 30; ++step) {
    Matrix damped = current.normal;
    for (int i = 0; i < kParameters; ++i) damped(i, i) *= 1 + damping;
    Vector change;
    if (!cv::solve(damped, current.right, change, cv::DECOMP_CHOLESKY)) break;
    const Linearized next = linearize(p + change, pixels, cost);
    if (!(next.cost <= current.cost)) {
      damping *= 10;
      if (damping > 1e6) break;
      continue;
    }
    p += change;
    current = next;
    damping = std::max(damping / 10, 1e-9);
    const double moved_px = std::abs(change(kShiftStart)) + std::abs(change(kShiftEnd));
    if (moved_px < until_px && std::abs(change(kLogBlur)) < 10 * until_px) break;
  }
  return p;
}

}  // namespace

std::optional<EdgeFit> fit_edge(std::span<const EdgePixel> pixels) {
  if (pixels.size() < kMinPixels) return std::nullopt;
  const auto guess = first_guess(pixels);
  if (!guess) return std::nullopt;
  Vector p = *guess;
  const double contrast = std::abs(2 * p(kHalfStepStart));
  if (!(contrast > 0)) return std::nullopt;
  // Leniently at first, far from the solution; then with the noise that was found there.
  p = minimize(p, pixels, {kTuning * std::max(robust_scale(p, pixels), 0.05 * contrast)}, 1e-2);
  p = minimize(p, pixels, {kTuning * std::max(robust_scale(p, pixels), 0.01 * contrast)}, 1e-4);

  EdgeFit fit;
  fit.shift_start_px = p(kShiftStart);
  fit.shift_end_px = p(kShiftEnd);
  fit.blur_px = std::exp(p(kLogBlur));
  fit.step = p(kHalfStepStart) + p(kHalfStepEnd);
  fit.noise = robust_scale(p, pixels);
  const bool same_direction = p(kHalfStepStart) * p(kHalfStepEnd) > 0;
  const bool finite = std::isfinite(fit.shift_start_px + fit.shift_end_px + fit.blur_px + fit.step);
  if (!finite || !same_direction || std::abs(fit.step) < 3 * fit.noise) return std::nullopt;
  return fit;
}

}  // namespace catchlight::tracking
