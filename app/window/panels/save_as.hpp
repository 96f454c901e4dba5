// Asks under which other name the scene file is to be saved.
#pragma once

#include <optional>
#include <string>

#include "app/window/surface/gui_items.hpp"

namespace catchlight::app {

class SaveAs {
 public:
  /// Draws a button with a menu that asks for a name. The file to be written, when that is asked for: it lies beside the scene
  /// file, from whose folder the scene names its files.
  std::optional<std::string> draw(const std::string& scene_file, GuiItems& items);

 private:
  std::string name_;
};

}  // namespace catchlight::app
