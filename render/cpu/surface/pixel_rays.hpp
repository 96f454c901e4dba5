// The directions that a camera's pixels look in.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/projection.hpp"

namespace catchlight::render {

/// Undistorted normalised coordinates (x / z, y / z in the camera frame) of places in the picture. A lens with distortion gets a
/// table, which is made anew only for another camera.
class PixelRays {
 public:
  /// `limit`: the camera's distortion limit.
  void set_camera(const CameraModel& camera, const DistortionLimit& limit);

  /// So many columns and rows after the picture's last are known, too.
  static constexpr int kBeyond = 4;

  /// At a pixel's centre. NaN where the lens sees nothing.
  glm::vec2 at(int x, int y) const {
    return table_.empty() ? first_ + glm::vec2(x, y) * step_ : table_[static_cast<std::size_t>(y) * columns() + x];
  }

  /// `offset` (-0.5 to 0.5) away from a pixel's centre: the lens bends nothing within a pixel.
  glm::vec2 at(int x, int y, const glm::vec2& offset) const;

 private:
  int columns() const { return camera_->width_px + kBeyond; }

  std::optional<CameraModel> camera_;
  glm::vec2 first_{0}, step_{1};  ///< without distortion: at pixel (0, 0), and from pixel to pixel
  std::vector<glm::vec2> table_;
};

}  // namespace catchlight::render
