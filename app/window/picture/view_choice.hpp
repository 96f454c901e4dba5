// The menu of what the picture shows.
#pragma once

#include "app/window/picture/picture_view.hpp"
#include "app/window/surface/gui_items.hpp"

namespace catchlight::app {

/// Draws the menu `view`, whose entries are `view NAME`, and what the chosen view can be set to. `frame`: as shown; may be null.
void draw_view_choice(PictureView& picture, const DrawnFrame* frame, GuiItems& items);

}  // namespace catchlight::app
