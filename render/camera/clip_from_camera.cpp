#include "render/camera/clip_from_camera.hpp"

namespace catchlight::render {

glm::dmat4 clip_from_camera(const CameraModel& camera, double near_m) {
  const double w = camera.width_px, h = camera.height_px;
  glm::dmat4 clip(0.0);
  clip[0][0] = 2 * camera.fx_px / w;
  clip[1][1] = 2 * camera.fy_px / h;
  clip[2][0] = (2 * camera.cx_px + 1) / w - 1;
  clip[2][1] = (2 * camera.cy_px + 1) / h - 1;
  clip[2][3] = 1;
  clip[3][2] = near_m;
  return clip;
}

PixelRect visible_rect(const CameraModel& camera, const DistortionLimit& limit, const RigidTransform& camera_from_tag,
                       const Bounds& box, double near_m) {
  constexpr int kSteps = 8;
  const glm::dvec3 min_m(box.min_m), max_m(box.max_m);
  const PixelRect picture{0, 0, camera.width_px, camera.height_px};
  glm::dvec2 low(1e30), high(-1e30);
  int in_front = 0, behind = 0;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      for (int k = 0; k <= kSteps; ++k) {
        const bool on_surface = i % kSteps == 0 || j % kSteps == 0 || k % kSteps == 0;
        if (!on_surface) continue;
        const glm::dvec3 p = camera_from_tag * glm::mix(min_m, max_m, glm::dvec3(i, j, k) / double{kSteps});
        const auto px = p.z < near_m ? std::nullopt : project_px(camera, p, &limit);
        if (!px) {
          ++behind;
          continue;
        }
        ++in_front;
        low = glm::min(low, *px);
        high = glm::max(high, *px);
      }
    }
  }
  if (in_front == 0) return {};
  if (behind > 0) return picture;
  const glm::dvec2 border = glm::dvec2(2.0) + (camera.has_distortion() ? (high - low) / 32.0 : glm::dvec2(0.0));
  // Clamped while still floating: a point near the camera's plane may project beyond what an int holds.
  const glm::dvec2 size(camera.width_px, camera.height_px);
  const glm::dvec2 first = glm::clamp(glm::floor(low - border), glm::dvec2(0), size);
  const glm::dvec2 last = glm::clamp(glm::ceil(high + border) + 1.0, glm::dvec2(0), size);
  const PixelRect rect{int(first.x), int(first.y), int(last.x - first.x), int(last.y - first.y)};
  return rect.empty() ? PixelRect{} : rect;
}

}  // namespace catchlight::render
