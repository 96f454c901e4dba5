// Apertures drawn by the program, for diffraction: squares of one channel, 1 where light passes, edges antialiased (a pixel is
// the mean over its area). The same at every size but for resolution, and the same on every machine: no library's random numbers.
#pragma once

#include "catchlight/image.hpp"

namespace catchlight::render {

/// The diaphragm of a lens. Its corners lie on circle_aperture()'s rim.
struct Diaphragm {
  int blades;
  double curvature = 0.03;   ///< a blade's curvature, relative to that rim's: 0 straight, 1 round
  double rotation_deg = 10;  ///< angle of the first corner, from the right downwards
};
Image diaphragm_aperture(const Diaphragm& diaphragm, int size_px);

/// An open lens.
Image circle_aperture(int size_px);

/// An eye's pupil behind lashes of the upper and the lower lid.
Image eyelash_aperture(int size_px);

/// An open lens with specks and scratches on it.
Image dusty_aperture(int size_px);

}  // namespace catchlight::render
