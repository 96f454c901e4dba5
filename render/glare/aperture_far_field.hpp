// Where an aperture sends the light of a distant point: Fraunhofer diffraction, as Kakimoto, Matsuoka, Nishita, Naemura &
// Harashima (Glare Generation Based on Wave Optics, 2004) use it for glare.
#pragma once

#include <vector>

#include "catchlight/image.hpp"

namespace catchlight::render {

/// |FFT(aperture)|^2 as energy over directions. A direction is a spatial frequency of the aperture in cycles over its picture's
/// width: times wavelength / width it is an angle in radians.
class ApertureFarField {
 public:
  /// `aperture`: square, one channel, how much of the wave's amplitude passes (0 to 1); a pixel is the mean over its area, and
  /// what that blurs is undone. It is padded with darkness to at least `transform_size` pixels a side, so that directions are
  /// sampled aperture.width / size apart. Throws Error: not square, not one channel, nothing passes, NaN or Inf.
  ApertureFarField(const Image& aperture, int transform_size);

  /// Share of all energy that goes into [x0, x1] x [y0, y1], for x0 >= 0; the other half is the same turned by 180 degrees.
  /// Samples are squares of constant energy. Nothing goes beyond +-limit().
  double share(double x0, double x1, double y0, double y1) const;

  /// The aperture's resolution ends here: half its pixels.
  double limit() const { return 0.5 * pixels_; }
  /// Distance between samples, as a direction.
  double sample() const { return static_cast<double>(pixels_) / size_; }

 private:
  void accumulate(const Image& spectrum);
  double integral(double column, double row) const;

  int pixels_, size_, columns_;
  std::vector<double> integrals_;  ///< sum of the samples left of and above each corner; columns_ + 1 by size_ + 1 corners
};

}  // namespace catchlight::render
