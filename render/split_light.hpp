// The light of a scene, as its points and its shadow maps take it.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "render/math/sh.hpp"
#include "render/probe/light_samples.hpp"
#include "render/render_scene.hpp"

namespace catchlight::render {

/// All of the light, and what of it comes from the lights that are split off.
struct SplitLight {
  ShRgb whole, split_off;            ///< all of it, and the samples' part of it; the latter is empty without samples
  std::vector<LightSample> samples;  ///< the samples that have shadow maps
};

SplitLight split_light(const RenderScene& scene);

SplitLight turned(const SplitLight& light, const glm::dmat3& rotation);

}  // namespace catchlight::render
