// How a pinhole camera sees the plane of one tag.
#pragma once

#include <optional>

#include "catchlight/camera.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/track.hpp"

namespace catchlight::tracking {

/// One ideal (undistorted) pixel's point on the tag's plane.
struct PlanePoint {
  glm::dvec2 cell;            ///< from the top left corner of the detected square, u right and v down, in cells
  glm::dvec3 point_camera_m;  ///< the same in the camera frame
  glm::dmat2 cell_per_px;     ///< d cell / d ideal pixel; columns: along x, along y
};

class TagView {
 public:
  TagView(const CameraModel& camera, const RigidTransform& camera_from_tag, double size_m, int cells_across);

  /// Empty where the pixel's ray does not meet the plane in front of the camera.
  std::optional<PlanePoint> at(const glm::dvec2& ideal_px) const;

  /// The cell coordinate alone.
  std::optional<glm::dvec2> cell_at(const glm::dvec2& ideal_px) const;

  /// The pixel at which a cell coordinate is seen, without distortion; empty behind the camera.
  std::optional<glm::dvec2> ideal_px(const glm::dvec2& cell) const;

 private:
  glm::dvec2 focal_px_, per_focal_px_, center_px_;
  RigidTransform camera_from_tag_;
  double cell_m_, half_size_m_;
  glm::dmat3 cell_from_px_;  ///< of (x, y, 1): the cell and 1, all over the depth in metres
};

/// A covariance in pixels, seen in cells.
inline Covariance2 in_cells(const Covariance2& px2, const glm::dmat2& cell_per_px) {
  const glm::dvec2 along_x = cell_per_px[0], along_y = cell_per_px[1];
  const glm::dvec2 x = along_x * px2.xx + along_y * px2.xy, y = along_x * px2.xy + along_y * px2.yy;
  return {x.x * along_x.x + y.x * along_y.x, x.x * along_x.y + y.x * along_y.y, x.y * along_x.y + y.y * along_y.y};
}

}  // namespace catchlight::tracking
