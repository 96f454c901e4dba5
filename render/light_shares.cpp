#include "render/light_shares.hpp"

#include "render/receiver_light.hpp"
#include "render/split_light.hpp"

namespace catchlight::render {
namespace {

void darken(ReflectionMap& map) {
  for (Image& level : map.levels) std::ranges::fill(level.data, 0.0f);
}

}  // namespace

RenderScene lit_alone(const RenderScene& scene, std::span<const LightSample> lights) {
  RenderScene alone = scene;
  alone.lights.assign(lights.begin(), lights.end());
  alone.light = project_to_sh(lights, scene.transfer.bands);
  darken(alone.reflections);
  darken(alone.rest_reflections);
  for (Material& material : alone.mesh.materials) material.emissive = material.unlit_color = glm::vec3(0);
  alone.transfer_key.clear();  // what is found of it is not worth keeping
  return alone;
}

CompositorSettings settings_alone(CompositorSettings settings) {
  settings.glare.enabled = false;
  settings.look = Look::camera;
  settings.tone = {};
  settings.reflection_rays = 0;
  return settings;
}

FrameView view_alone(FrameView view) {
  view.black = glm::vec3(0);
  return view;
}

glm::dvec3 plane_share(const RenderScene& scene, std::span<const LightSample> lights, const glm::dmat3& tag_from_light) {
  const auto& unshadowed = scene.transfer.receiver_unshadowed;
  glm::dvec3 share(0.0);
  if (unshadowed.empty()) return share;
  const SplitLight whole = split_light(scene);
  const OpenPlaneLight all = open_plane_light(unshadowed, turned(whole, tag_from_light));
  SplitLight chosen = whole;
  chosen.samples.assign(lights.begin(), lights.end());
  const glm::dvec3 part = open_plane_light(unshadowed, turned(chosen, tag_from_light)).lights, sum = all.lights + all.rest;
  for (int c = 0; c < 3; ++c)
    if (sum[c] > 0) share[c] = part[c] / sum[c];
  return share;
}

Image light_of(const Layers& layers, const glm::dvec3& plane_share) {
  Image light(layers.plate.width, layers.plate.height);
  const std::size_t pixels = static_cast<std::size_t>(light.width) * light.height;
  for (std::size_t i = 0; i < pixels; ++i)
    for (int c = 0; c < 3; ++c) {
      const std::size_t at = 3 * i + static_cast<std::size_t>(c), object = 4 * i;
      light.data[at] = static_cast<float>(plane_share[c]) * layers.plate.data[at] * layers.shadow.data[at] *
                           (1 - layers.object.data[object + 3]) +
                       layers.object.data[object + static_cast<std::size_t>(c)];
    }
  return light;
}

}  // namespace catchlight::render
