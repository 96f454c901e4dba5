#include "tracking/edge_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <vector>

namespace catchlight::tracking {
namespace {

constexpr int kParameters = 8;
constexpr std::size_t kFewestPixels = 24;
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
  const double erf = std::erf(z);
  const double bell = std::exp(-z * z) * std::numbers::inv_sqrtpi * std::numbers::sqrt2 / blur;  // d erf / d distance
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

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
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
  const double low = median(minus), high = median(plus);
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
  return 1.4826 * median(sizes);
}

/// Cauchy's loss: outliers (a finger, a highlight) weigh ever less, yet never zero, so that the fit can still find them good.
struct Cost {
  double scale;
  double weight(double residual) const { return 1 / (1 + square(residual)); }
  double loss(double residual) const { return std::log1p(square(residual)); }
  double square(double residual) const { return residual * residual / (scale * scale); }
};

double total_cost(const Vector& p, std::span<const EdgePixel> pixels, const Cost& cost) {
  double sum = 0;
  for (const EdgePixel& pixel : pixels) sum += cost.loss(pixel.value - model(p, pixel).value);
  return sum;
}

/// Levenberg-Marquardt from `p` until steps of the edge fall below 1e-4 px.
Vector minimize(Vector p, std::span<const EdgePixel> pixels, const Cost& cost) {
  double damping = 1e-3, current = total_cost(p, pixels, cost);
  for (int step = 0; step < 30; ++step) {
    Matrix normal = Matrix::zeros();
    Vector right = Vector::zeros();
    for (const EdgePixel& pixel : pixels) {
      const Modelled modelled = model(p, pixel);
      const double residual = pixel.value - modelled.value, weight = cost.weight(residual);
      for (int i = 0; i < kParameters; ++i) {
        right(i) += weight * residual * modelled.gradient(i);
        for (int j = 0; j <= i; ++j) normal(i, j) += weight * modelled.gradient(i) * modelled.gradient(j);
      }
    }
    for (int i = 0; i < kParameters; ++i) {
      for (int j = 0; j < i; ++j) normal(j, i) = normal(i, j);
      normal(i, i) *= 1 + damping;
    }
    Vector change;
    if (!cv::solve(normal, right, change, cv::DECOMP_CHOLESKY)) break;
    const double improved = total_cost(p + change, pixels, cost);
    if (!(improved <= current)) {
      damping *= 10;
      if (damping > 1e6) break;
      continue;
    }
    p += change;
    current = improved;
    damping = std::max(damping / 10, 1e-9);
    if (std::abs(change(kShiftStart)) + std::abs(change(kShiftEnd)) < 1e-4 && std::abs(change(kLogBlur)) < 1e-3) break;
  }
  return p;
}

}  // namespace

std::optional<EdgeFit> fit_edge(std::span<const EdgePixel> pixels) {
  if (pixels.size() < kFewestPixels) return std::nullopt;
  const auto guess = first_guess(pixels);
  if (!guess) return std::nullopt;
  Vector p = *guess;
  const double contrast = std::abs(2 * p(kHalfStepStart));
  if (!(contrast > 0)) return std::nullopt;
  double noise = 0;
  for (const double floor : {0.05, 0.01}) {  // shares of the contrast: the first pass is lenient, far from the solution
    noise = robust_scale(p, pixels);
    p = minimize(p, pixels, {2.4 * std::max(noise, floor * contrast)});
  }

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
