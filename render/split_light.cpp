#include "render/split_light.hpp"

namespace catchlight::render {

SplitLight split_light(const RenderScene& scene) {
  SplitLight light{scene.light, {}, scene.lights};
  if (!scene.lights.empty()) light.split_off = project_to_sh(scene.lights, scene.transfer.bands);
  return light;
}

ContentHash content_hash(const std::string& transfer_key, const SplitLight& light) {
  ContentHash hash;
  hash.add_bytes(transfer_key.data(), transfer_key.size());
  hash.add(light.whole);
  hash.add(light.split_off);
  for (const LightSample& sample : light.samples) {
    hash.add(sample.direction);
    hash.add(sample.irradiance);
  }
  return hash;
}

SplitLight turned(const SplitLight& light, const glm::dmat3& rotation) {
  SplitLight result{rotate_sh(light.whole, rotation), {}, light.samples};
  if (!light.split_off.empty()) result.split_off = rotate_sh(light.split_off, rotation);
  for (LightSample& sample : result.samples) sample.direction = rotation * sample.direction;
  return result;
}

}  // namespace catchlight::render
