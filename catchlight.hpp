// Shared plain data: all that tracking/ and render/ have in common. docs/conventions.md has the frames and units.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <stdexcept>
#include <string>

namespace catchlight {

/// Bad input or environment: the message names the file, line or option, what was expected and what to do. Exit code 1.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A command line that cannot be carried out. Exit code 2.
struct UsageError : Error {
  using Error::Error;
};

/// Receives one warning for the user; libraries never print.
using WarningHandler = std::function<void(const std::string&)>;

/// Receives the finished share of a long task, 0 to 1, never decreasing.
using ProgressHandler = std::function<void(double)>;

/// Rigid motion named by its frames: `a_from_b` maps b's coordinates (metres) to a's.
struct RigidTransform {
  glm::dmat3 rotation{1.0};
  glm::dvec3 translation_m{0.0};
};

inline glm::dvec3 operator*(const RigidTransform& a_from_b, const glm::dvec3& point_b_m) {
  return a_from_b.rotation * point_b_m + a_from_b.translation_m;
}

/// a_from_c = a_from_b * b_from_c.
inline RigidTransform operator*(const RigidTransform& a_from_b, const RigidTransform& b_from_c) {
  return {a_from_b.rotation * b_from_c.rotation, a_from_b * b_from_c.translation_m};
}

inline RigidTransform inverse(const RigidTransform& a_from_b) {
  const glm::dmat3 rotation = glm::transpose(a_from_b.rotation);
  return {rotation, -(rotation * a_from_b.translation_m)};
}

/// OpenCV's pinhole camera: x right, y down, z forward; the centre of the top-left pixel is (0, 0).
/// Distortion is OpenCV's rational model in OpenCV's order k1 k2 p1 p2 k3 k4 k5 k6.
struct CameraModel {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
  std::array<double, 8> distortion{};

  bool has_distortion() const {
    return std::any_of(distortion.begin(), distortion.end(), [](double k) { return k != 0.0; });
  }
};

/// Half-open rectangle of pixels.
struct PixelRect {
  int x = 0, y = 0, width = 0, height = 0;
  bool empty() const { return width <= 0 || height <= 0; }
  bool operator==(const PixelRect&) const = default;
};

inline PixelRect intersect(const PixelRect& a, const PixelRect& b) {
  const int x = std::max(a.x, b.x), y = std::max(a.y, b.y);
  const int right = std::min(a.x + a.width, b.x + b.width), bottom = std::min(a.y + a.height, b.y + b.height);
  return {x, y, std::max(0, right - x), std::max(0, bottom - y)};
}

/// The smallest rectangle around both; an empty one counts for nothing.
inline PixelRect unite(const PixelRect& a, const PixelRect& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  const int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
  return {x, y, std::max(a.x + a.width, b.x + b.width) - x, std::max(a.y + a.height, b.y + b.height) - y};
}

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
  return std::copysign(
      magnitude <= 0.0031308 ? magnitude * 12.92 : 1.055 * std::pow(magnitude, 1.0 / 2.4) - 0.055, linear);
}

/// Light of a code. PQ (SMPTE ST 2084) and HLG (ARIB STD-B67, scene-referred) are scaled so that 203 cd/m2, reference white, is 1 (ITU-R BT.2408).
inline double linear_from_code(TransferFunction transfer, double code) {
  switch (transfer) {
    case TransferFunction::srgb: return linear_from_srgb(code);
    case TransferFunction::linear: return code;
    case TransferFunction::gamma22: return std::pow(std::max(code, 0.0), 2.2);
    case TransferFunction::gamma28: return std::pow(std::max(code, 0.0), 2.8);
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
