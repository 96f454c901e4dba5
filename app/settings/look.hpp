// Looks: named sets of settings.
#pragma once

#include "app/settings/scene_settings.hpp"

namespace catchlight::app {

/// Sets what `scene.look` names, except for `kept` keys. After scene file and command line.
void apply_look(SceneSettings& scene, const std::set<std::string>& kept);

/// What the compositor is told of exposure.
render::ToneSettings tone_settings(const SceneSettings& scene);

/// Whether frames change in which nothing virtual is in sight.
bool recodes_every_frame(const SceneSettings& scene);

}  // namespace catchlight::app
