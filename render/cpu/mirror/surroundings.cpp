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

/// Finds where the frame shows the place of the plane z = 0, blurred over `width_m`.
void Surroundings::find_in_frame(Target& target, float width_m) const {
  glm::vec3 p = camera_from_tag_ * glm::vec3(target.place_m, 0) + tag_in_camera_m_;
  if (is_distorted_) p = glm::vec3(distorted(camera_, limit_, p));
  if (!(p.z > 0)) return;
  const glm::vec2 focal(camera_.fx_px, camera_.fy_px), centre(camera_.cx_px, camera_.cy_px);
  target.in_plate = (glm::vec2(p) / p.z * focal + centre + 0.5f) / glm::vec2(camera_.width_px, camera_.height_px);
  const glm::vec2 to_rim = 1.0f - glm::abs(2.0f * target.in_plate - 1.0f);
  target.in_frame = glm::smoothstep(0.0f, 2 * kFrameFade, std::min(to_rim.x, to_rim.y));
  target.plate_level = std::max(std::log2(width_m * static_cast<float>(camera_.fx_px) / p.z), 0.0f);
}

Surroundings::Target Surroundings::find(const glm::vec3& origin_m, const glm::vec3& direction, float spread, float roughness,
                                        bool with_lights) const {
  Target target;
  target.on_receiver = plate_ && direction.z < 0 && origin_m.z > 0;
  target.map = target.on_receiver || with_lights ? &probe_ : &rest_;
  target.probe_level = shading::level_of(roughness, target.map->levels());
  glm::vec3 from_probe = direction;
  if (target.on_receiver) {
    const float distance_m = -origin_m.z / direction.z;
    target.place_m = glm::vec2(origin_m) + distance_m * glm::vec2(direction);
    shadow_->prefetch(target.place_m);
    find_in_frame(target, 2 * spread * distance_m);
    // Where the frame does not show the place, the probe does, from where it was captured.
    from_probe = glm::vec3(target.place_m, 0) - probe_in_tag_m_;
  }
  if (target.in_frame == 1) return target;
  target.probe_direction = light_from_tag_ * from_probe;
  target.map->prefetch(target.probe_direction, target.probe_level);
  return target;
}

glm::vec3 Surroundings::radiance(const Target& target) const {
  glm::vec3 light(0);
  if (target.in_frame < 1) light = target.map->sample(target.probe_direction, target.probe_level);
  if (!target.on_receiver) return light;
  if (target.in_frame > 0) light = glm::mix(light, plate_->sample(target.in_plate, target.plate_level), target.in_frame);
  return shadow_->ratio(target.place_m) * light;
}

}  // namespace catchlight::render
