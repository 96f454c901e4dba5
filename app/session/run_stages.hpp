// The way of all frames of a shot, several of them at once.
#pragma once

#include <functional>

#include "app/session/session.hpp"

namespace catchlight::app {

struct StageOptions {
  /// Which frames of the range are drawn; the others are skipped. Called on the thread that draws.
  std::function<bool(const FrameJob&)> wants = [](const FrameJob&) { return true; };
  /// Sees each frame that was drawn, on the thread that draws, before it is written.
  std::function<void(const FrameJob&)> look = [](const FrameJob&) {};
  std::size_t queue_length = 4;  ///< frames that may wait before each step; 1 for live footage, which must not fall behind
};

/// while (auto job = session.decode()) session.track(*job), session.render(*job), write(*job), with a thread for each of these
/// four (live footage is decoded and tracked on one): each sees the frames in order, so what is written is the same. Frames are
/// drawn on the calling thread, as the GL context is its own; write is called on another. Prepares the session. Throws what the
/// earliest frame to fail throws, as the loop would.
void run_stages(Session& session, const std::function<void(FrameJob&)>& write, StageOptions options = {});

}  // namespace catchlight::app
