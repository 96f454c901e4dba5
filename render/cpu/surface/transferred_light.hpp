// Precomputed radiance transfer on the processor: light coefficients in, light per point out.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/split_light.hpp"

namespace catchlight::render {

/// For each point the sum of light times transfer, less what lights that are split off send directly, never negative and never
/// NaN. `transfer` holds light.whole.size() coefficients a point; `direct`, the part of it that met no other surface, as many, or
/// none where no light is split off.
std::vector<glm::vec3> transferred_light(std::span<const glm::vec3> transfer, std::span<const glm::vec3> direct,
                                         const SplitLight& light);

}  // namespace catchlight::render
