// The camera that took the footage.
#pragma once

#include <algorithm>
#include <array>
#include <glm/glm.hpp>

namespace catchlight {

/// OpenCV's pinhole camera: x right, y down, z forward; the centre of the top-left pixel is (0, 0).
/// Distortion is OpenCV's rational model in OpenCV's order k1 k2 p1 p2 k3 k4 k5 k6.
struct CameraModel {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
  std::array<double, 8> distortion{};
  glm::dvec3 vignetting{0.0};  ///< v1, v2, v3 of vignetting_at()

  bool operator==(const CameraModel&) const = default;

  bool has_distortion() const {
    return std::any_of(distortion.begin(), distortion.end(), [](double k) { return k != 0.0; });
  }
};

/// Half the picture's diagonal, squared: vignetting's unit of length.
double half_diagonal_px2(const CameraModel& camera);

/// The share of the light that reaches the sensor at a pixel, r half diagonals from the principal point:
/// 1 + v1 r^2 + v2 r^4 + v3 r^6, never less than 0.
double vignetting_at(const CameraModel& camera, const glm::dvec2& px);

}  // namespace catchlight
