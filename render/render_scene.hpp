// A scene ready to be drawn.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "render/math/sh.hpp"
#include "render/mesh/mesh.hpp"
#include "render/probe/light_samples.hpp"
#include "render/probe/prefilter.hpp"
#include "render/transfer/transfer.hpp"

namespace catchlight::render {

inline constexpr int kMaxLightSamples = 128;

/// What the scene is made of, all in the tag frame. Light is scene-linear radiance, Rec. 709.
struct RenderScene {
  Mesh mesh;
  Transfer transfer;
  ShRgb light;                           ///< all of it: transfer.bands^2 coefficients
  std::vector<LightSample> lights = {};  ///< split off; at most kMaxLightSamples, none where the transfer has no direct part
  ReflectionMap reflections;             ///< all of it
  ReflectionMap rest_reflections = {};   ///< less the compact lights; used where there are any
  glm::vec3 probe_in_tag_m{0.0f};        ///< where the probe was captured
  std::string transfer_key = {};  ///< of mesh and transfer, in the cache; empty: nothing that is made of them is kept there
};

}  // namespace catchlight::render
