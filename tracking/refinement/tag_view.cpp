#include "tracking/refinement/tag_view.hpp"

namespace catchlight::tracking {
namespace {

glm::dmat3 cell_from_px(const glm::dvec2& focal_px, const glm::dvec2& center_px, const RigidTransform& camera_from_tag,
                        double cell_m, double half_size_m) {
  const glm::dmat3 slopes_from_px{
      {1 / focal_px.x, 0, 0}, {0, 1 / focal_px.y, 0}, {-center_px.x / focal_px.x, -center_px.y / focal_px.y, 1}};
  const glm::dmat3 plane_from_slopes =
      glm::inverse(glm::dmat3(camera_from_tag.rotation[0], camera_from_tag.rotation[1], camera_from_tag.translation_m));
  const double half_cells = half_size_m / cell_m;
  const glm::dmat3 cell_from_plane{{1 / cell_m, 0, 0}, {0, -1 / cell_m, 0}, {half_cells, half_cells, 1}};
  return cell_from_plane * plane_from_slopes * slopes_from_px;
}

}  // namespace

TagView::TagView(const CameraModel& camera, const RigidTransform& camera_from_tag, double size_m, int cells_across)
    : focal_px_(camera.fx_px, camera.fy_px),
      per_focal_px_(1.0 / focal_px_),
      center_px_(camera.cx_px, camera.cy_px),
      camera_from_tag_(camera_from_tag),
      cell_m_(size_m / cells_across),
      half_size_m_(size_m / 2),
      cell_from_px_(cell_from_px(focal_px_, center_px_, camera_from_tag, cell_m_, half_size_m_)) {}

std::optional<PlanePoint> TagView::at(const glm::dvec2& ideal_px) const {
  const glm::dvec3 over_depth = cell_from_px_ * glm::dvec3(ideal_px, 1);
  if (!(over_depth.z > 0)) return std::nullopt;
  const double depth_m = 1 / over_depth.z;
  PlanePoint point;
  point.cell = glm::dvec2(over_depth) * depth_m;
  point.point_camera_m = glm::dvec3((ideal_px - center_px_) * per_focal_px_, 1) * depth_m;
  for (int i = 0; i < 2; ++i) point.cell_per_px[i] = (glm::dvec2(cell_from_px_[i]) - point.cell * cell_from_px_[i].z) * depth_m;
  return point;
}

std::optional<glm::dvec2> TagView::cell_at(const glm::dvec2& ideal_px) const {
  const glm::dvec3 over_depth = cell_from_px_ * glm::dvec3(ideal_px, 1);
  if (!(over_depth.z > 0)) return std::nullopt;
  return glm::dvec2(over_depth) / over_depth.z;
}

std::optional<glm::dvec2> TagView::ideal_px(const glm::dvec2& cell) const {
  const glm::dvec3 on_tag_m(cell.x * cell_m_ - half_size_m_, half_size_m_ - cell.y * cell_m_, 0);
  const glm::dvec3 point_m = camera_from_tag_ * on_tag_m;
  if (!(point_m.z > 0)) return std::nullopt;
  return focal_px_ * glm::dvec2(point_m) / point_m.z + center_px_;
}

}  // namespace catchlight::tracking
