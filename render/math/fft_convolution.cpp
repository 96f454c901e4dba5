#include "render/math/fft_convolution.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <string>

#include "catchlight/error.hpp"
#include "catchlight/util/parallel.hpp"

namespace catchlight::render {
namespace {

constexpr float kLargest = 1e20f;

std::string size_of(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

cv::Mat as_mat(Image& plane) {
  return cv::Mat(plane.height, plane.width, CV_32FC1, plane.data.data());
}

/// The same for a plane that mulSpectrums() only reads.
cv::Mat as_mat(const Image& plane) {
  return cv::Mat(plane.height, plane.width, CV_32FC1, const_cast<float*>(plane.data.data()));
}

/// What of `size` pixels around their centre can reach another pixel of `image_size`.
struct KernelSpan {
  int first, last;  ///< pixels of the kernel
  int centre;
  KernelSpan(int size, int image_size)
      : first(std::max(0, size / 2 - (image_size - 1))), last(std::min(size - 1, size / 2 + image_size - 1)), centre(size / 2) {}
  /// The smallest fast size at which what wraps round falls outside the image; cv::dft() skips no rows of a single column.
  int transform_size(int image_size) const {
    return cv::getOptimalDFTSize(std::max(2, image_size + std::max(centre - first, last - centre)));
  }
};

void check_kernel(const Image& kernel, int image_width, int image_height) {
  if (kernel.width < 1 || kernel.height < 1 || kernel.channels != 3)
    throw Error("a convolution's kernel must be an RGB image, got " + size_of(kernel.width, kernel.height) + " pixels of " +
                std::to_string(kernel.channels) + " channels");
  if (image_width < 1 || image_height < 1)
    throw Error("a convolution's image must not be empty, got " + size_of(image_width, image_height));
  if (!std::all_of(kernel.data.begin(), kernel.data.end(), [](float v) { return std::isfinite(v); }))
    throw Error("a convolution's kernel has values that are not finite");
}

float held(float value) {
  return std::isfinite(value) ? std::clamp(value, -kLargest, kLargest) : 0.0f;
}

}  // namespace

FftConvolution::FftConvolution(const Image& kernel, int image_width, int image_height)
    : width_(image_width), height_(image_height) {
  check_kernel(kernel, image_width, image_height);
  const KernelSpan columns(kernel.width, width_), rows(kernel.height, height_);
  const int width = columns.transform_size(width_), height = rows.transform_size(height_);
  parallel_for(3, 0, [&](std::size_t c) {
    Image plane(width, height, 1);
    for (int y = rows.first; y <= rows.last; ++y) {
      for (int x = columns.first; x <= columns.last; ++x)
        *plane.pixel((x - columns.centre + width) % width, (y - rows.centre + height) % height) = kernel.pixel(x, y)[c];
    }
    cv::Mat spectrum = as_mat(plane);
    cv::dft(spectrum, spectrum);
    spectrum *= 1.0 / (static_cast<double>(width) * height);
    spectra_[c] = std::move(plane);
  });
}

Image FftConvolution::convolve(const Image& image) const {
  if (image.width != width_ || image.height != height_ || image.channels != 3)
    throw Error("this convolution is for RGB images of " + size_of(width_, height_) + " pixels, got " +
                size_of(image.width, image.height) + " of " + std::to_string(image.channels) + " channels");
  Image result(width_, height_);
  parallel_for(3, 0, [&](std::size_t c) {
    Image plane(transform_width(), transform_height(), 1);
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) *plane.pixel(x, y) = held(image.pixel(x, y)[c]);
    cv::Mat spectrum = as_mat(plane);
    cv::dft(spectrum, spectrum, 0, height_);  // the rows below are zero, and below they are not wanted
    cv::mulSpectrums(spectrum, as_mat(spectra_[c]), spectrum, 0);
    cv::dft(spectrum, spectrum, cv::DFT_INVERSE | cv::DFT_REAL_OUTPUT, height_);
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) result.pixel(x, y)[c] = *plane.pixel(x, y);
  });
  return result;
}

}  // namespace catchlight::render
