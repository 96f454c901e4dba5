// What a change of settings asks to be done again.
#pragma once

#include <set>

#include "app/settings/parameters.hpp"
#include "app/settings/scene_settings.hpp"

namespace catchlight::app {

/// What differs between two scenes, parameter by parameter; empty where nothing does.
std::set<ChangeCost> costs_of_change(const SceneSettings& before, const SceneSettings& after);

}  // namespace catchlight::app
