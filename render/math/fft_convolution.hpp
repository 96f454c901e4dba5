// Convolution of an image with a kernel as large as the image itself, by OpenCV's cv::dft: FFTW's licence (GPL) is not this
// project's (MIT).
#pragma once

#include <array>

#include "catchlight/image.hpp"

namespace catchlight::render {

/// Linear convolution, out(x) = sum over d of kernel(centre + d) * image(x - d), per channel, with nothing beyond the image's
/// edges: it is padded with zeros until nothing wraps round. Keeps the kernel's spectrum, so that a sequence pays for it once: 12
/// bytes for each pixel of transform_width() x transform_height(), about four times the image's. Floats throughout: rounding adds
/// less than 1e-5 of the largest value times the largest of the kernel.
class FftConvolution {
 public:
  /// The kernel's centre is pixel (width / 2, height / 2), rounded down; what of it lies further from there than the image is
  /// large reaches nothing and is left out. Throws Error: kernel or image empty, not 3 channels, a kernel with NaN or Inf.
  FftConvolution(const Image& kernel, int image_width, int image_height);

  /// The convolution of an image of the size and channels that the object was made for (else Error). NaN and Inf in it count as 0
  /// and what is beyond +-1e20 is held there, so that one bad pixel does not spread over all. Deterministic, whatever the
  /// number of threads.
  Image convolve(const Image& image) const;

  int transform_width() const { return spectra_[0].width; }
  int transform_height() const { return spectra_[0].height; }

 private:
  int width_, height_;
  std::array<Image, 3> spectra_;  ///< the kernel's, by channel, in OpenCV's packed form, divided by the number of pixels
};

}  // namespace catchlight::render
