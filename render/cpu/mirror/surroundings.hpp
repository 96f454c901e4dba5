// What lies around the object: the receiver, seen in the frame itself where the frame shows it, and the probe.
#pragma once

#include <array>
#include <cstddef>
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

  /// Where a ray ends that passes the object.
  struct Target {
    const CubeTexture* map = nullptr;
    glm::vec3 probe_direction{0};  ///< in the probe's frame
    float probe_level = 0;
    bool on_receiver = false;  ///< at place_m of it, where it is darkened by the object
    glm::vec2 place_m{0};
    float in_frame = 0;  ///< to what share the frame shows it: there, blurred as level plate_level is; the probe shows the rest
    glm::vec2 in_plate{0};
    float plate_level = 0;
  };

  /// Finds where a ray ends and begins to fetch what radiance() will read there. `direction` has length 1, `spread` is the
  /// tangent of the ray's half width, `roughness` that of the surface whose lobe is as wide.
  Target find(const glm::vec3& origin_m, const glm::vec3& direction, float spread, float roughness, bool with_lights) const;

  /// Radiance that arrives from there.
  glm::vec3 radiance(const Target& target) const;

  /// Finds many targets with find(i) and calls use(i, target) for each so much later that what it reads has been fetched.
  template <typename Find, typename Use>
  static void for_each_target(std::size_t count, const Find& find, const Use& use) {
    std::array<Target, kFetchedAhead> targets;
    for (std::size_t i = 0; i < count + kFetchedAhead; ++i) {
      Target& target = targets[i % kFetchedAhead];
      if (i >= kFetchedAhead && i - kFetchedAhead < count) use(i - kFetchedAhead, target);
      if (i < count) target = find(i);
    }
  }

  /// That of the probe alone. Without lights: less those that make highlights.
  glm::vec3 probe_radiance(const glm::vec3& direction, float roughness, bool with_lights) const;

 private:
  static constexpr std::size_t kFetchedAhead = 12;

  void find_in_frame(Target& target, float width_m) const;

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
