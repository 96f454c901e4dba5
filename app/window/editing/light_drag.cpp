#include "app/window/editing/light_drag.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "app/settings/parameters.hpp"
#include "catchlight/color.hpp"

namespace catchlight::app {

SceneSettings with_probe_turned(SceneSettings settings, double angle_deg) {
  const double yaw_deg = std::remainder(settings.probe.yaw_deg + angle_deg, 360.0);
  set_parameter(settings, *find_parameter("probe.yaw_deg"), std::round(10 * yaw_deg) / 10);
  return settings;
}

const render::LightSummary* strongest_light(std::span<const render::LightSummary> lights, const glm::dmat3& tag_from_light) {
  const render::LightSummary* strongest = nullptr;
  double most = 0;
  for (const render::LightSummary& light : lights) {
    const double falls_on_tag = (tag_from_light * light.direction).z * glm::dot(kLuminanceWeights, light.irradiance);
    if (falls_on_tag > most) most = falls_on_tag, strongest = &light;
  }
  return strongest;
}

double turn_for_shadow_deg(const glm::dvec3& light, const glm::dvec3& up, const glm::dvec2& shadow) {
  constexpr int kSteps = 3600;
  const glm::dvec3 along = glm::dot(up, light) * up, across = light - along, beside = glm::cross(up, light);
  /// The cosine between the wanted direction and the light's own: -1 where the shadow lies in it.
  const auto missed = [&](double turn_rad) {
    const glm::dvec3 turned = along + std::cos(turn_rad) * across + std::sin(turn_rad) * beside;
    const double length = glm::length(glm::dvec2(turned));
    return turned.z > 0 && length > 1e-9 ? glm::dot(glm::dvec2(turned), shadow) / length : 1;
  };
  int best = 0;
  double least = missed(0);
  for (int step = 1; step < kSteps; ++step) {
    const double here = missed(2 * glm::pi<double>() * step / kSteps);
    if (here < least - 1e-12) least = here, best = step;
  }
  return 360.0 * best / kSteps;
}

ShadowDrag::ShadowDrag(SceneSettings start, const glm::dvec3& light, const glm::dvec3& up, const glm::dvec2& foot_m)
    : start_(std::move(start)), light_(light), up_(up), foot_m_(foot_m) {}

SceneSettings ShadowDrag::at(const glm::dvec2& place_m) const {
  constexpr double kMinDistance_m = 1e-4;
  const glm::dvec2 from_foot_m = place_m - foot_m_;
  const double distance_m = glm::length(from_foot_m);
  if (distance_m < kMinDistance_m) return start_;
  return with_probe_turned(start_, turn_for_shadow_deg(light_, up_, from_foot_m / distance_m));
}

}  // namespace catchlight::app
