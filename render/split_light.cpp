#include "render/split_light.hpp"

namespace catchlight::render {

SplitLight split_light(const RenderScene& scene) {
  SplitLight light{scene.light, {}, scene.lights};
  if (!scene.lights.empty()) light.split_off = project_to_sh(scene.lights, scene.transfer.bands);
  return light;
}

SplitLight turned(const SplitLight& light, const glm::dmat3& rotation) {
  SplitLight result{rotate_sh(light.whole, rotation), {}, light.samples};
  if (!light.split_off.empty()) result.split_off = rotate_sh(light.split_off, rotation);
  for (LightSample& sample : result.samples) sample.direction = rotation * sample.direction;
  return result;
}

}  // namespace catchlight::render
