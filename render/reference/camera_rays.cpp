#include "render/reference/camera_rays.hpp"

namespace catchlight::render::reference {

CameraRays::CameraRays(const CameraModel& camera, const RigidTransform& camera_from_tag)
    : camera_(camera),
      limit_(lens_limit(camera)),
      camera_from_tag_(camera_from_tag),
      origin_tag_m_(inverse(camera_from_tag).translation_m) {}

// Newton's method on render/camera/lens.hpp's distorted(), with slopes by differences.
glm::dvec2 CameraRays::without_distortion(const glm::dvec2& seen) const {
  constexpr double kStep = 1e-6, kClose = 1e-12;
  if (!camera_.has_distortion()) return seen;
  const auto at = [&](const glm::dvec2& p) { return glm::dvec2(distorted(camera_, limit_, {p, 1})); };
  glm::dvec2 p = seen;
  for (int i = 0; i < 30; ++i) {
    const glm::dvec2 here = at(p), missing = seen - here;
    if (glm::dot(missing, missing) < kClose * kClose) break;
    const glm::dmat2 slope((at(p + glm::dvec2(kStep, 0)) - here) / kStep, (at(p + glm::dvec2(0, kStep)) - here) / kStep);
    if (std::abs(glm::determinant(slope)) < 1e-9) break;
    p += glm::inverse(slope) * missing;
  }
  return p;
}

glm::dvec3 CameraRays::direction_tag(const glm::dvec2& pixel) const {
  const glm::dvec2 seen((pixel.x - camera_.cx_px) / camera_.fx_px, (pixel.y - camera_.cy_px) / camera_.fy_px);
  return glm::normalize(glm::transpose(camera_from_tag_.rotation) * glm::dvec3(without_distortion(seen), 1));
}

std::optional<glm::dvec2> CameraRays::pixel_of(const glm::dvec3& point_tag_m) const {
  const glm::dvec3 point_camera_m = camera_from_tag_ * point_tag_m;
  if (!(point_camera_m.z > 0)) return std::nullopt;
  const glm::dvec3 seen = distorted(camera_, limit_, point_camera_m);
  return glm::dvec2(camera_.fx_px * seen.x / seen.z + camera_.cx_px, camera_.fy_px * seen.y / seen.z + camera_.cy_px);
}

}  // namespace catchlight::render::reference
