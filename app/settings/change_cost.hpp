// What a change of settings asks to be made again.
#pragma once

#include <set>

#include "app/settings/parameter_kinds.hpp"
#include "app/settings/scene_settings.hpp"

namespace catchlight::app {

/// The costs of all parameters in which two scenes differ.
std::set<ChangeCost> costs_of_change(const SceneSettings& before, const SceneSettings& after);

}  // namespace catchlight::app
