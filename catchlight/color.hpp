// sRGB, and what light is worth to the eye.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace catchlight {

/// IEC 61966-2-1, exact, also for values beyond [0, 1] (odd extension below 0).
inline double linear_from_srgb(double code) {
  const double magnitude = std::abs(code);
  return std::copysign(magnitude <= 0.04045 ? magnitude / 12.92 : std::pow((magnitude + 0.055) / 1.055, 2.4), code);
}

inline double srgb_from_linear(double linear) {
  const double magnitude = std::abs(linear);
  return std::copysign(magnitude <= 0.0031308 ? magnitude * 12.92 : 1.055 * std::pow(magnitude, 1.0 / 2.4) - 0.055, linear);
}

/// Rec. 709 luminance of linear RGB; the project's one set of weights.
inline constexpr glm::dvec3 kLuminanceWeights{0.2126, 0.7152, 0.0722};

}  // namespace catchlight
