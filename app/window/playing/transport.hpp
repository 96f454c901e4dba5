// The controls of the playhead.
#pragma once

#include <cstdint>

#include "app/window/playing/playhead.hpp"
#include "app/window/surface/gui_items.hpp"

namespace catchlight::app {

/// Draws buttons and timeline into the current ImGui window, and takes the keys: space, arrows, home, end, [ and ].
void draw_transport(Playhead& playhead, std::int64_t frame_number, double time_s, GuiItems& items);

}  // namespace catchlight::app
