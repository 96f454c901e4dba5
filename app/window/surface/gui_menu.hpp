// Menus that hang below a button.
#pragma once

#include <string>

#include "app/window/surface/gui_items.hpp"

namespace catchlight::app {

/// Draws a button that says `text`, the control `name`. Where its menu is open, what follows up to ImGui::EndPopup() is in it.
bool begin_menu(const std::string& text, const std::string& name, GuiItems& items);

}  // namespace catchlight::app
