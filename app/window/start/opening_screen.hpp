// What the window shows without a recording: what can be dropped on it, and what can be opened.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/window/surface/gui_items.hpp"

namespace catchlight::app {

/// A recording that came with the program.
struct Example {
  std::string name, folder;
  std::string about;  ///< the first line of its scene file
};

/// The recordings beside the program: in share/catchlight of where it is installed, or in the source tree that it was built in.
std::vector<Example> shipped_recordings();

class OpeningScreen {
 public:
  /// Draws into the current ImGui window. The folder of the recording that was chosen, if one was. `last`: folders; those that
  /// are gone are not shown. Named "recent 1" and so on, and "example matte".
  std::optional<std::string> draw(const std::vector<std::string>& last, GuiItems& items);
  /// The same in the middle of it.
  std::optional<std::string> draw_centered(const std::vector<std::string>& last, GuiItems& items);

 private:
  std::optional<std::vector<Example>> examples_;  ///< looked for when they are first shown
};

}  // namespace catchlight::app
