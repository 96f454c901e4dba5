// One frame on its way from the footage to the output.
#pragma once

#include "app/media/pixels/frame.hpp"
#include "catchlight/composite.hpp"
#include "catchlight/track.hpp"
#include "render/frame_view.hpp"

namespace catchlight::app {

/// A frame and what becomes of it; every step of the session fills in its own part.
struct FrameJob {
  Frame image;                   ///< decode()
  bool is_before_range = false;  ///< decode(): the tracker's memory and the adapting exposure need it, the output does not
  TrackRow track = {};           ///< track()
  render::FrameView view = {};   ///< view()
  Composite result = {};         ///< render(); its rectangle is empty where nothing virtual reached the frame
};

}  // namespace catchlight::app
