#include "catchlight/camera.hpp"

#include <cmath>

namespace catchlight {

double half_diagonal_px2(const CameraModel& camera) {
  return (std::pow(camera.width_px, 2) + std::pow(camera.height_px, 2)) / 4;
}

double vignetting_at(const CameraModel& camera, const glm::dvec2& px) {
  const glm::dvec2 off_px = px - glm::dvec2(camera.cx_px, camera.cy_px);
  const double r2 = glm::dot(off_px, off_px) / half_diagonal_px2(camera);
  const glm::dvec3& v = camera.vignetting;
  return std::max(1 + r2 * (v.x + r2 * (v.y + r2 * v.z)), 0.0);
}

}  // namespace catchlight
