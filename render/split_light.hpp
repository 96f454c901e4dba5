// The light of a scene, as its points and its shadow maps take it.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "render/cache/content_hash.hpp"
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

/// A hash of what object and receiver look like under a light: of the transfer's key, and of the light.
ContentHash content_hash(const std::string& transfer_key, const SplitLight& light);

SplitLight turned(const SplitLight& light, const glm::dmat3& rotation);

}  // namespace catchlight::render
