// The irradiance of the light samples on the receiving plane, with the object's shadows, by rays.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/mesh/bounds.hpp"
#include "render/probe/light_samples.hpp"
#include "render/rays/ray_scene.hpp"
#include "render/receiver_light.hpp"

namespace catchlight::render {

struct PlaneLights {
  ReceiverTexels texels;
  std::vector<glm::vec3> irradiance_over_pi;  ///< a texel each, row by row from min

  bool empty() const { return irradiance_over_pi.empty(); }
  /// Texels from the rectangle's first corner to a place of the plane.
  glm::vec2 texel_at(const glm::vec2& place_m) const;
  /// Linear between the texels' middles.
  glm::vec3 at(const glm::vec2& texel) const;
};

/// Rays go from every fourth texel to every sample, and from those between to the samples that their neighbours do not agree on.
/// `object`: the box around what casts shadows.
PlaneLights plane_lights(std::span<const LightSample> samples_tag, const RayScene& rays, const ReceiverTexels& texels,
                         const Bounds& object);

}  // namespace catchlight::render
