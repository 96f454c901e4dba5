// Turns the probe by hand.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "app/settings/scene_settings.hpp"
#include "render/probe/probe_lights.hpp"

namespace catchlight::app {

/// The settings with the probe turned on by `angle_deg`, to tenths of a degree.
SceneSettings with_probe_turned(SceneSettings settings, double angle_deg);

/// The light whose shadow on the tag's plane is the strongest; null where none shines on it.
const render::LightSummary* strongest_light(std::span<const render::LightSummary> lights, const glm::dmat3& tag_from_light);

/// How far the probe has to be turned about `up` so that what comes from `light` throws its shadow on the tag's plane as near as
/// can be in the direction `shadow`: the best of tenths of a degree. Directions are of length 1, in the tag's frame.
double turn_for_shadow_deg(const glm::dvec3& light, const glm::dvec3& up, const glm::dvec2& shadow);

/// A drag of a light's shadow around an object's foot, from where it began.
class ShadowDrag {
 public:
  /// `light` and `up`: directions in the tag's frame, of length 1, under the settings `start`.
  ShadowDrag(SceneSettings start, const glm::dvec3& light, const glm::dvec3& up, const glm::dvec2& foot_m);

  /// The settings with the pointer at a place of the tag's plane: the shadow points there from the foot.
  SceneSettings at(const glm::dvec2& place_m) const;

 private:
  SceneSettings start_;
  glm::dvec3 light_, up_;
  glm::dvec2 foot_m_;
};

}  // namespace catchlight::app
