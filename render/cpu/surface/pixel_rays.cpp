#include "render/cpu/surface/pixel_rays.hpp"

#include <limits>

#include "catchlight/util/parallel.hpp"

namespace catchlight::render {

void PixelRays::set_camera(const CameraModel& camera, const DistortionLimit& limit) {
  if (camera_ == camera) return;
  camera_ = camera;
  table_.clear();
  step_ = {1 / camera.fx_px, 1 / camera.fy_px};
  first_ = {-camera.cx_px / camera.fx_px, -camera.cy_px / camera.fy_px};
  if (!camera.has_distortion()) return;
  const std::size_t rows = static_cast<std::size_t>(camera.height_px) + kBeyond;
  std::vector<glm::vec2> table(rows * columns());
  parallel_for(rows, 0, [&](std::size_t y) {
    for (int x = 0; x < columns(); ++x) {
      const auto ideal_px = undistort_px(camera, glm::dvec2(x, y), &limit);
      const float nothing = std::numeric_limits<float>::quiet_NaN();
      table[y * columns() + x] = ideal_px ? first_ + glm::vec2(*ideal_px) * step_ : glm::vec2(nothing);
    }
  });
  table_ = std::move(table);
}

glm::vec2 PixelRays::at(int x, int y, const glm::vec2& offset) const {
  const glm::vec2 middle = at(x, y);
  if (table_.empty()) return middle + offset * step_;
  return middle + offset.x * (at(x + 1, y) - middle) + offset.y * (at(x, y + 1) - middle);
}

}  // namespace catchlight::render
