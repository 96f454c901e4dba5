// Every effect with its switch, in one place.
#pragma once

#include "app/window/editing/settings_history.hpp"
#include "app/window/surface/gui_items.hpp"

namespace catchlight::app {

/// Draws a box for each row of the parameter table that switches something off: flags, switches, and choices of which one is
/// "none", but for those of the track. Unchecked it is off; checked it is what the file says, or what the program chooses.
void draw_effect_switches(SettingsHistory& history, GuiItems& items);

}  // namespace catchlight::app
