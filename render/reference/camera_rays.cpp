#include "render/reference/camera_rays.hpp"

namespace catchlight::render::reference {

CameraRays::CameraRays(const CameraModel& camera, const RigidTransform& camera_from_tag)
    : camera_(camera),
      limit_(distortion_limit(camera)),
      camera_from_tag_(camera_from_tag),
      origin_tag_m_(inverse(camera_from_tag).translation_m) {}

glm::dvec3 CameraRays::direction_tag(const glm::dvec2& pixel) const {
  const glm::dvec2 ideal_px = undistort_px(camera_, pixel, &limit_).value_or(pixel);
  const glm::dvec2 slope((ideal_px.x - camera_.cx_px) / camera_.fx_px, (ideal_px.y - camera_.cy_px) / camera_.fy_px);
  return glm::normalize(glm::transpose(camera_from_tag_.rotation) * glm::dvec3(slope, 1));
}

std::optional<glm::dvec2> CameraRays::pixel_of(const glm::dvec3& point_tag_m) const {
  return project_px(camera_, camera_from_tag_ * point_tag_m, &limit_);
}

}  // namespace catchlight::render::reference
