// What the camera does to the virtual layer in one frame, besides exposure, distortion and vignetting.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace catchlight::render {

/// The sensor's noise: a channel's variance = slope * value + floor, in exposed linear light.
struct SensorNoise {
  bool enabled = false;
  glm::vec3 slope{0.0f}, floor{0.0f};
  /// Takes two independent numbers that a block of pixels shares and one of each pixel's own, all of variance 1, to RGB of
  /// variance 1.
  glm::mat3 mix{1.0f};
  glm::ivec2 block_shift{0};  ///< log2 of a block's pixels across and down
  std::uint32_t frame = 0;    ///< seeds the noise: no two frames are alike, and each is alike every time
};

/// How the tag moves in the camera frame while the shutter is open, evenly and with the frame's pose in the middle: its point X
/// moves by turn x X + shift.
struct TagMotion {
  glm::dvec3 turn_rad{0.0}, shift_m{0.0};
};

struct CameraEffects {
  SensorNoise noise;
  double defocus_px2 = 0;  ///< variance of the blur along each axis, beyond a pixel's own
  TagMotion motion;
};

}  // namespace catchlight::render
