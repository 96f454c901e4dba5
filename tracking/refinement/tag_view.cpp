#include "tracking/refinement/tag_view.hpp"

namespace catchlight::tracking {

TagView::TagView(const CameraModel& camera, const RigidTransform& camera_from_tag, double size_m, int cells_across)
    : focal_px_(camera.fx_px, camera.fy_px),
      center_px_(camera.cx_px, camera.cy_px),
      camera_from_tag_(camera_from_tag),
      plane_from_slopes_(
          glm::inverse(glm::dmat3(camera_from_tag.rotation[0], camera_from_tag.rotation[1], camera_from_tag.translation_m))),
      cell_m_(size_m / cells_across),
      half_size_m_(size_m / 2) {}

std::optional<PlanePoint> TagView::at(const glm::dvec2& ideal_px) const {
  const glm::dvec2 slope = (ideal_px - center_px_) / focal_px_;
  const glm::dvec3 plane = plane_from_slopes_ * glm::dvec3(slope, 1);  // (x, y, 1) / depth
  if (!(plane.z > 0)) return std::nullopt;
  const double depth_m = 1 / plane.z;
  const glm::dvec2 on_tag_m = glm::dvec2(plane) * depth_m;
  const glm::dvec3 right = camera_from_tag_.rotation[0], up = camera_from_tag_.rotation[1];
  PlanePoint point;
  point.cell = {(on_tag_m.x + half_size_m_) / cell_m_, (half_size_m_ - on_tag_m.y) / cell_m_};
  point.point_camera_m = glm::dvec3(slope, 1) * depth_m;
  const double scale = cell_m_ / depth_m;
  const glm::dvec2 along_u = focal_px_ * (glm::dvec2(right) - slope * right.z) * scale;
  const glm::dvec2 along_v = -focal_px_ * (glm::dvec2(up) - slope * up.z) * scale;
  const double determinant = along_u.x * along_v.y - along_u.y * along_v.x;
  point.cell_per_px = glm::dmat2(along_v.y, -along_u.y, -along_v.x, along_u.x) / determinant;
  return point;
}

std::optional<glm::dvec2> TagView::cell_at(const glm::dvec2& ideal_px) const {
  const glm::dvec3 plane = plane_from_slopes_ * glm::dvec3((ideal_px - center_px_) / focal_px_, 1);
  if (!(plane.z > 0)) return std::nullopt;
  return glm::dvec2(plane.x / plane.z + half_size_m_, half_size_m_ - plane.y / plane.z) / cell_m_;
}

std::optional<glm::dvec2> TagView::ideal_px(const glm::dvec2& cell) const {
  const glm::dvec3 on_tag_m(cell.x * cell_m_ - half_size_m_, half_size_m_ - cell.y * cell_m_, 0);
  const glm::dvec3 point_m = camera_from_tag_ * on_tag_m;
  if (!(point_m.z > 0)) return std::nullopt;
  return focal_px_ * glm::dvec2(point_m) / point_m.z + center_px_;
}

}  // namespace catchlight::tracking
