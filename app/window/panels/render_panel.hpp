// Draws the marked range into a file, and shows the command that does the same.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "app/window/editing/opened_recording.hpp"
#include "app/window/editing/settings_history.hpp"
#include "app/window/panels/background_run.hpp"
#include "app/window/playing/playhead.hpp"
#include "app/window/surface/gui_items.hpp"

namespace catchlight::app {

class RenderPanel {
 public:
  /// Draws the panel into the current ImGui window. `first_number`: of the footage's first frame.
  void draw(const OpenedRecording& opened, const SettingsHistory& history, const Playhead& playhead, std::int64_t first_number,
            GuiItems& items);

 private:
  std::string output_ = "comp.mp4";
  std::unique_ptr<BackgroundRun> run_;  ///< the last one; null before the first
};

}  // namespace catchlight::app
