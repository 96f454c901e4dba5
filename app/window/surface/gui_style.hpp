// The window's typeface and colours.
#pragma once

namespace catchlight::app {

/// Sets fonts and colours of the current ImGui context: dark and grey, so that pictures are judged right. `scale`: pixels a unit.
void set_gui_style(float scale);

}  // namespace catchlight::app
