#include "app/settings/look.hpp"

#include "app/settings/parameters.hpp"
#include "catchlight/util/enum_names.hpp"
#include "render/settings.hpp"

namespace catchlight::app {
namespace {

struct LookSetting {
  const char* key;
  ParameterValue value;
};

/// 0.825 s is what 2 % of the way sixty times a second is, and 0.972 a pixel is
/// 0.9 a texel of 128.
const LookSetting kClassic[] = {
    {"exposure.mode", name_of(ExposureMode::automatic)},
    {"exposure.key", 0.72},
    {"exposure.adapt_bright_s", 0.825},
    {"exposure.adapt_dark_s", 0.825},
    {"glare.bloom_strength", 0.2},
    {"glare.streak_strength", 0.2},
    {"glare.streak_attenuation", 0.9723},
};

}  // namespace

void apply_look(SceneSettings& scene, const std::set<std::string>& kept) {
  if (scene.look != render::Look::classic) return;
  const std::set<std::string> by_hand = scene.by_hand;
  for (const LookSetting& setting : kClassic)
    if (!kept.contains(setting.key)) set_parameter(scene, *find_parameter(setting.key), setting.value);
  scene.by_hand = by_hand;
}

render::ToneSettings tone_settings(const SceneSettings& scene) {
  return {.enabled = scene.exposure.mode == ExposureMode::automatic,
          .key = scene.exposure.key,
          .has_white_point = scene.look != render::Look::classic};
}

bool recodes_every_frame(const SceneSettings& scene) {
  return tone_settings(scene).enabled || scene.look == render::Look::classic;
}

}  // namespace catchlight::app
