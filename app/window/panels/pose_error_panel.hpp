// The pose's error over the shot.
#pragma once

#include <vector>

#include "app/window/playing/playhead.hpp"
#include "app/window/playing/pose_errors.hpp"
#include "app/window/surface/gui_items.hpp"

namespace catchlight::app {

/// Draws the curves, the states and the playhead into the current ImGui window; whoever clicks into them goes to that frame: the
/// control `pose error curve`.
void draw_pose_errors(const std::vector<PoseError>& errors, Playhead& playhead, GuiItems& items);

}  // namespace catchlight::app
