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
  ShRgb whole, split_off;            ///< the second is the samples' part of the first; empty without samples
  std::vector<LightSample> samples;  ///< as the shadow maps have them
};

SplitLight split_light(const RenderScene& scene);

SplitLight turned(const SplitLight& light, const glm::dmat3& rotation);

}  // namespace catchlight::render
