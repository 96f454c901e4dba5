// What a lens makes of a point of white light: its aperture's far field at every wavelength, in the frame's pixels.
#pragma once

#include "catchlight/image.hpp"
#include "render/glare/aperture_far_field.hpp"

namespace catchlight::render {

struct ApertureOptics {
  double aperture_mm;  ///< width of the aperture's picture
  double focal_px;     ///< the camera's focal length: an angle of 1 rad is that many pixels
};

inline constexpr double kShortest_nm = 380, kLongest_nm = 780;

/// How finely an aperture must be drawn and transformed for diffraction `wanted_reach_px` away; less where that would need more
/// than 4096 pixels, the picture's own `picture_px` or a transform of 8192.
struct AperturePlan {
  int picture_px, transform_px;
  int reach_px;  ///< how far the point-spread function goes
};
AperturePlan plan_aperture(const ApertureOptics& optics, int wanted_reach_px, int picture_px);

/// Share of a monochromatic point's light that falls into each pixel within reach_px of it: one channel, 2 * reach_px + 1
/// squared. Intensity is |FFT|^2 scaled by wavelength * focal / width in size and by its inverse square in strength.
Image monochromatic_psf(const ApertureFarField& field, const ApertureOptics& optics, double wavelength_nm, int reach_px);

/// The same for a point of equal energy at all wavelengths from 380 to 780 nm, seen by the CIE 1931 observer (the fit of Wyman,
/// Sloan & Shirley, Simple Analytic Approximations to the CIE XYZ Color Matching Functions, 2013): linear Rec. 709, white
/// balanced. Colours outside the primaries are greyed at their luminance until none is negative. It fades out towards where the
/// shortest wave's far field ends. Every channel sums to 1, so that a grey world stays grey: what falls further counts to the
/// middle pixel, which the light itself keeps.
Image aperture_psf(const ApertureFarField& field, const ApertureOptics& optics, int reach_px);

/// The point-spread function without its middle: what is seen as glare.
Image glare_of(Image psf);

}  // namespace catchlight::render
