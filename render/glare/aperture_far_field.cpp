#include "render/glare/aperture_far_field.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <opencv2/core.hpp>
#include <string>

#include "catchlight/error.hpp"

namespace catchlight::render {
namespace {

void check(const Image& aperture) {
  if (aperture.width != aperture.height || aperture.width < 1 || aperture.channels != 1)
    throw Error("an aperture must be a square picture of one channel, got " + std::to_string(aperture.width) + " x " +
                std::to_string(aperture.height) + " pixels of " + std::to_string(aperture.channels));
  if (!std::all_of(aperture.data.begin(), aperture.data.end(), [](float v) { return std::isfinite(v) && v >= 0; }))
    throw Error("an aperture has pixels that are negative or not finite");
  if (std::none_of(aperture.data.begin(), aperture.data.end(), [](float v) { return v > 0; }))
    throw Error("an aperture is black all over: no light passes");
}

/// The spectrum of the padded aperture, in OpenCV's packed form.
Image packed_spectrum(const Image& aperture, int size) {
  Image plane(size, size, 1);
  for (int y = 0; y < aperture.height; ++y) std::copy_n(aperture.pixel(0, y), aperture.width, plane.pixel(0, y));
  cv::Mat mat(size, size, CV_32FC1, plane.data.data());
  cv::dft(mat, mat, 0, aperture.height);
  return plane;
}

/// |spectrum|^2 at column 0 <= kx <= size / 2 and row 0 <= ky < size. Rows hold re(0), re(1), im(1), re(2) ...; the columns of kx
/// = 0 and size / 2 are real signals' spectra themselves and packed downwards in the same way.
double power(const Image& packed, int kx, int ky) {
  const int size = packed.width;
  const auto squared = [](double a, double b) { return a * a + b * b; };
  if (kx > 0 && 2 * kx < size) return squared(*packed.pixel(2 * kx - 1, ky), *packed.pixel(2 * kx, ky));
  const int column = kx == 0 ? 0 : size - 1, row = std::min(ky, size - ky);
  if (row == 0) return squared(*packed.pixel(column, 0), 0);
  if (2 * row == size) return squared(*packed.pixel(column, size - 1), 0);
  return squared(*packed.pixel(column, 2 * row - 1), *packed.pixel(column, 2 * row));
}

/// 1 / the energy that the mean over a pixel leaves, by frequency (1 / size cycles a pixel apart).
std::vector<double> pixel_gains(int size) {
  std::vector<double> gains(static_cast<std::size_t>(size / 2) + 1, 1.0);
  for (std::size_t k = 1; k < gains.size(); ++k) {
    const double phase = glm::pi<double>() * static_cast<double>(k) / size;
    gains[k] = phase * phase / (std::sin(phase) * std::sin(phase));
  }
  return gains;
}

}  // namespace

ApertureFarField::ApertureFarField(const Image& aperture, int transform_size) : pixels_(aperture.width) {
  check(aperture);
  size_ = std::max(pixels_, transform_size);
  while ((size_ = cv::getOptimalDFTSize(size_)) % 2 != 0) ++size_;
  columns_ = size_ / 2 + 1;
  accumulate(packed_spectrum(aperture, size_));
}

void ApertureFarField::accumulate(const Image& spectrum) {
  const std::vector<double> gains = pixel_gains(size_);
  const std::size_t stride = static_cast<std::size_t>(columns_) + 1;
  integrals_.assign(stride * (static_cast<std::size_t>(size_) + 1), 0.0);
  double total = 0;
  for (int row = 0; row < size_; ++row) {
    const int ky = (row + size_ / 2) % size_;  // rows from -size / 2 upwards
    const double row_gain = gains[static_cast<std::size_t>(std::min(ky, size_ - ky))];
    double sum = 0;
    const double* above = &integrals_[stride * static_cast<std::size_t>(row)];
    double* below = &integrals_[stride * (static_cast<std::size_t>(row) + 1)];
    for (int kx = 0; kx < columns_; ++kx) {
      const double energy = power(spectrum, kx, ky);
      total += kx == 0 || kx == size_ / 2 ? energy : 2 * energy;
      sum += energy * row_gain * gains[static_cast<std::size_t>(kx)];
      below[kx + 1] = above[kx + 1] + sum;
    }
  }
  for (double& value : integrals_) value /= total;
}

/// Sum of the samples left of `column` and above `row`, which count corners.
double ApertureFarField::integral(double column, double row) const {
  column = std::clamp(column, 0.0, static_cast<double>(columns_));
  row = std::clamp(row, 0.0, static_cast<double>(size_));
  const int x = std::min(static_cast<int>(column), columns_ - 1), y = std::min(static_cast<int>(row), size_ - 1);
  const double u = column - x, v = row - y;
  const double* corner =
      &integrals_[(static_cast<std::size_t>(columns_) + 1) * static_cast<std::size_t>(y) + static_cast<std::size_t>(x)];
  const double* next = corner + columns_ + 1;
  return (1 - v) * ((1 - u) * corner[0] + u * corner[1]) + v * ((1 - u) * next[0] + u * next[1]);
}

double ApertureFarField::share(double x0, double x1, double y0, double y1) const {
  // Sample k is the square from k - 1/2 to k + 1/2.
  const double scale = static_cast<double>(size_) / pixels_, middle = size_ / 2 + 0.5;
  const double left = x0 * scale + 0.5, right = x1 * scale + 0.5, top = y0 * scale + middle, bottom = y1 * scale + middle;
  return integral(right, bottom) - integral(left, bottom) - integral(right, top) + integral(left, top);
}

}  // namespace catchlight::render
