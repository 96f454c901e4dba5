// How codes stand for light by formula, and what light is worth to the eye.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace catchlight {

/// How the footage's codes (0..1) relate to scene-linear light (1 = sensor white). Video tagged BT.709 is read as sRGB:
/// cameras' BT.709 pictures are graded for, and converted from, the sRGB curve far more often than the bare BT.709 one.
enum class TransferFunction { srgb, linear, gamma22, gamma28, pq, hlg };

/// IEC 61966-2-1, exact, also for values beyond [0, 1] (odd extension below 0).
inline double linear_from_srgb(double code) {
  const double magnitude = std::abs(code);
  return std::copysign(magnitude <= 0.04045 ? magnitude / 12.92 : std::pow((magnitude + 0.055) / 1.055, 2.4), code);
}

inline double srgb_from_linear(double linear) {
  const double magnitude = std::abs(linear);
  return std::copysign(magnitude <= 0.0031308 ? magnitude * 12.92 : 1.055 * std::pow(magnitude, 1.0 / 2.4) - 0.055, linear);
}

/// Light of a code. PQ (SMPTE ST 2084) and HLG (ARIB STD-B67, scene-referred) are scaled so that 203 cd/m2, reference white, is 1
/// (ITU-R BT.2408).
inline double linear_from_code(TransferFunction transfer, double code) {
  switch (transfer) {
    case TransferFunction::srgb:
      return linear_from_srgb(code);
    case TransferFunction::linear:
      return code;
    case TransferFunction::gamma22:
      return std::pow(std::max(code, 0.0), 2.2);
    case TransferFunction::gamma28:
      return std::pow(std::max(code, 0.0), 2.8);
    case TransferFunction::pq: {
      const double root = std::pow(std::max(code, 0.0), 32.0 / 2523.0);
      return std::pow(std::max(root - 0.8359375, 0.0) / (18.8515625 - 18.6875 * root), 16384.0 / 2610.0) * 10000.0 / 203.0;
    }
    case TransferFunction::hlg: {
      const double e = std::max(code, 0.0);
      const double scene = e <= 0.5 ? e * e / 3.0 : (std::exp((e - 0.55991073) / 0.17883277) + 0.28466892) / 12.0;
      return scene / 0.26496256;  // code 0.75 is reference white
    }
  }
  return code;
}

/// Rec. 709 luminance of linear RGB; the project's one set of weights.
inline constexpr glm::dvec3 kLuminanceWeights{0.2126, 0.7152, 0.0722};

}  // namespace catchlight
