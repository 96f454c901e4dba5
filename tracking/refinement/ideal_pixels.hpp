// The place that each pixel would have without distortion, remembered: frames ask for the same pixels again and again.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "catchlight/camera.hpp"

namespace catchlight::tracking {

struct IdealPixel {
  glm::dvec2 ideal_px;
  glm::dmat2 ideal_per_seen{1.0};  ///< d ideal / d seen: the lens stretches blur as it does everything
};

/// undistort_px() of any place, with its slope.
std::optional<IdealPixel> ideal_pixel(const CameraModel& camera, const glm::dvec2& seen_px);

class IdealPixels {
 public:
  explicit IdealPixels(const CameraModel& camera);

  /// ideal_pixel() of a pixel's centre.
  std::optional<IdealPixel> at(int x, int y);

 private:
  CameraModel camera_;
  std::vector<std::vector<std::optional<IdealPixel>>> tiles_;  ///< each empty until asked for
  int tiles_across_;
};

}  // namespace catchlight::tracking
