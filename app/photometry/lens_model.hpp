// What the footage shows of its camera, beyond pose and exposure: grain, focus, shutter, motion.
#pragma once

#include <glm/glm.hpp>

namespace catchlight::app {

/// Variance of a channel, of exposed linear light in the footage's primaries = slope * value + floor: shot noise and read noise
/// (Foi et al. 2008, "Practical Poissonian-Gaussian noise modeling and fitting for single-image raw-data"). Of footage whose
/// colour is subsampled, luma's noise and that of the nearest colour sample together.
struct NoiseModel {
  glm::dvec3 slope{0.0}, floor{0.0};
  glm::dvec3 correlation{0.0};  ///< of red with green, red with blue, green with blue

  bool is_measured() const { return slope != glm::dvec3(0.0) || floor != glm::dvec3(0.0); }
};

/// How the tag moves in the camera frame from one frame to the next: a point X of it by turn x X + shift.
struct TagMotion {
  glm::dvec3 turn_rad{0.0}, shift_m{0.0};
};

/// What blurs the picture.
struct LensBlurModel {
  TagMotion motion;
  double shutter = 0;    ///< share of the frame's interval that it is open; 0: the footage shows no motion blur
  double focus_px2 = 0;  ///< variance along each axis by lens and pixel, without motion; 0: not measured
};

}  // namespace catchlight::app
