// A control for every row of the parameter table.
#pragma once

#include <string>

#include "app/window/gui_items.hpp"
#include "app/window/settings_history.hpp"

namespace catchlight::app {

class ParameterControls {
 public:
  /// Draws the groups into the current ImGui window; what is turned goes into the history.
  void draw(SettingsHistory& history, GuiItems& items);

  /// Shows the rows whose name or help holds the text; all where it is empty.
  void search(const std::string& text) { search_ = text; }
  /// What could not be taken, e.g. a path that is no file's; empty where the last change was taken.
  const std::string& refused() const { return refused_; }

 private:
  void draw_reset(const struct Parameter& parameter, std::size_t index, const std::string& name, SettingsHistory& history,
                  GuiItems& items);
  void draw_row(const struct Parameter& parameter, std::size_t index, SettingsHistory& history, GuiItems& items);

  std::string search_, refused_;
};

}  // namespace catchlight::app
