// What lies around the object: the receiver, seen in the frame itself where the frame shows it, and the probe.
#pragma once

#include <glm/glm.hpp>

#include "catchlight/projection.hpp"
#include "render/cpu/mirror/cube_texture.hpp"
#include "render/cpu/plate/plate_light.hpp"
#include "render/cpu/receiver/receiver_shadow.hpp"
#include "render/frame_view.hpp"

namespace catchlight::render {

class Surroundings {
 public:
  /// Keeps references to what it is given for a frame. `shadow` and `plate` are null where mirrors do not show the receiver.
  Surroundings(const CubeTexture& probe, const CubeTexture& rest, const glm::vec3& probe_in_tag_m)
      : probe_(probe), rest_(rest), probe_in_tag_m_(probe_in_tag_m) {}

  void set_view(const FrameView& view, const DistortionLimit& limit, const ReceiverShadow* shadow, const PlateLight* plate);

  /// Radiance that arrives at `origin_m` from `direction` (length 1) past the object. `spread` is the tangent of the ray's half
  /// width, `roughness` that of the surface whose lobe is as wide.
  glm::vec3 radiance(const glm::vec3& origin_m, const glm::vec3& direction, float spread, float roughness,
                     bool with_lights) const;

  /// Begins to fetch what radiance() will read.
  void prefetch(const glm::vec3& origin_m, const glm::vec3& direction, float roughness, bool with_lights) const;

  /// That of the probe alone. Without lights: less those that make highlights.
  glm::vec3 probe_radiance(const glm::vec3& direction, float roughness, bool with_lights) const;

 private:
  glm::vec3 receiver_radiance(const glm::vec2& place_m, float width_m, float roughness) const;

  const CubeTexture &probe_, &rest_;
  glm::vec3 probe_in_tag_m_;
  CameraModel camera_;
  DistortionLimit limit_{};
  bool is_distorted_ = false;
  glm::mat3 camera_from_tag_{1}, light_from_tag_{1};
  glm::vec3 tag_in_camera_m_{0};
  const ReceiverShadow* shadow_ = nullptr;
  const PlateLight* plate_ = nullptr;
};

}  // namespace catchlight::render
