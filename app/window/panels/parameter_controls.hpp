// A control for every row of the parameter table.
#pragma once

#include <string>

#include "app/window/editing/settings_history.hpp"
#include "app/window/playing/shot_player.hpp"
#include "app/window/surface/gui_items.hpp"

namespace catchlight::app {

class ParameterControls {
 public:
  /// Draws the groups into the current ImGui window; what is turned goes into the history.
  void draw(SettingsHistory& history, const PlayerStatus& status, GuiItems& items);

 private:
  void draw_reset(const struct Parameter& parameter, std::size_t index, const std::string& name, SettingsHistory& history,
                  GuiItems& items);
  void draw_row(const struct Parameter& parameter, std::size_t index, SettingsHistory& history, const PlayerStatus& status,
                GuiItems& items);

  std::string search_;   ///< rows whose name or help holds it are shown; all where it is empty
  std::string refused_;  ///< why the last change was not taken; empty where it was
};

}  // namespace catchlight::app
