// Draws what the tracker found over a finished frame: `overlay --debug`.
#pragma once

#include "app/media/pixels/frame.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/composite.hpp"
#include "catchlight/track.hpp"

namespace catchlight::app {

/// Draws into `composite`, which was put into `frame` already: the tag's outline (white), a cross on each corner (magenta) and
/// half a tag's side of its axes (x red, y green, z blue), all through the lens; and frame number, state, residual and ambiguity
/// as text. A frame without a pose gets the text alone. Lines and text keep their size beside the picture at every resolution.
/// Pixels that nothing is drawn on stay as they are.
void draw_debug(const Frame& frame, const TrackRow& row, const CameraModel& camera, double tag_size_m, Composite& composite);

}  // namespace catchlight::app
