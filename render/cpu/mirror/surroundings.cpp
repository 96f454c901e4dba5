#include "render/cpu/mirror/surroundings.hpp"

#include <algorithm>
#include <cmath>

#include "shaders/shading.h"

namespace catchlight::render {
namespace {

/// Over the outer share of the frame the probe takes over from it.
constexpr float kFrameFade = 0.04f;

}  // namespace

void Surroundings::set_view(const FrameView& view, const DistortionLimit& limit, const ReceiverShadow* shadow,
                            const PlateLight* plate) {
  camera_ = view.camera;
  limit_ = limit;
  is_distorted_ = camera_.has_distortion();
  camera_from_tag_ = glm::mat3(view.camera_from_tag.rotation);
  tag_in_camera_m_ = glm::vec3(view.camera_from_tag.translation_m);
  light_from_tag_ = glm::mat3(glm::transpose(view.tag_from_light));
  shadow_ = shadow;
  plate_ = plate;
}

glm::vec3 Surroundings::probe_radiance(const glm::vec3& direction, float roughness, bool with_lights) const {
  const CubeTexture& map = with_lights ? probe_ : rest_;
  return map.sample(light_from_tag_ * direction, shading::level_of(roughness, map.levels()));
}

/// Radiance of the plane z = 0 at a place, blurred over `width_m`; darkened by the object. Where the frame does not show the
/// place, the probe does, from where it was captured.
glm::vec3 Surroundings::receiver_radiance(const glm::vec2& place_m, float width_m, float roughness) const {
  const glm::vec3 ratio = shadow_->ratio(place_m);
  glm::vec3 p = camera_from_tag_ * glm::vec3(place_m, 0) + tag_in_camera_m_;
  if (is_distorted_) p = glm::vec3(distorted(camera_, limit_, p));
  float seen = 0;
  glm::vec2 place(0);
  if (p.z > 0) {
    const glm::vec2 focal(camera_.fx_px, camera_.fy_px), centre(camera_.cx_px, camera_.cy_px);
    place = (glm::vec2(p) / p.z * focal + centre + 0.5f) / glm::vec2(camera_.width_px, camera_.height_px);
    const glm::vec2 to_rim = 1.0f - glm::abs(2.0f * place - 1.0f);
    seen = glm::smoothstep(0.0f, 2 * kFrameFade, std::min(to_rim.x, to_rim.y));
  }
  glm::vec3 light(0);
  if (seen < 1) light = probe_radiance(glm::normalize(glm::vec3(place_m, 0) - probe_in_tag_m_), roughness, true);
  if (seen > 0) {
    const float pixels = width_m * static_cast<float>(camera_.fx_px) / p.z;
    light = glm::mix(light, plate_->sample(place, std::max(std::log2(pixels), 0.0f)), seen);
  }
  return ratio * light;
}

glm::vec3 Surroundings::radiance(const glm::vec3& origin_m, const glm::vec3& direction, float spread, float roughness,
                                 bool with_lights) const {
  if (!plate_ || direction.z >= 0 || origin_m.z <= 0) return probe_radiance(direction, roughness, with_lights);
  const float distance_m = -origin_m.z / direction.z;
  return receiver_radiance(glm::vec2(origin_m) + distance_m * glm::vec2(direction), 2 * spread * distance_m, roughness);
}

void Surroundings::prefetch(const glm::vec3& origin_m, const glm::vec3& direction, float roughness, bool with_lights) const {
  const CubeTexture& map = with_lights ? probe_ : rest_;
  if (!plate_ || direction.z >= 0 || origin_m.z <= 0)
    map.prefetch(light_from_tag_ * direction, shading::level_of(roughness, map.levels()));
  else
    shadow_->prefetch(glm::vec2(origin_m) - origin_m.z / direction.z * glm::vec2(direction));
}

}  // namespace catchlight::render
