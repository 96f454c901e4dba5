// The camera that took the footage.
#pragma once

#include <algorithm>
#include <array>

namespace catchlight {

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

}  // namespace catchlight
