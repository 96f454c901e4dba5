// Live footage in the window: how it comes in, how old it is on the screen, and takes of it.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "app/window/editing/settings_history.hpp"
#include "app/window/playing/playhead.hpp"
#include "app/window/playing/shot_player.hpp"
#include "app/window/surface/gui_items.hpp"

namespace catchlight::app {

class LivePanel {
 public:
  LivePanel();

  /// Draws into the current ImGui window what stands in the transport's place: pause, takes, and how the footage comes in. Takes
  /// the space key. `footage`: what it is called. Returns what a person should read of what went wrong; else nothing.
  std::string draw(LiveFeed& feed, const std::string& footage, const SettingsHistory& history, Playhead& playhead,
                   GuiItems& items);

  /// The window shows this frame now.
  void note_shown(const DrawnFrame& frame);

  /// What scripts may ask for: source, latency_ms, dropped_frames, take, take_frames.
  std::optional<std::string> value_of(const std::string& key, const LiveStatus& live) const;

 private:
  std::string draw_take(LiveFeed& feed, const LiveStatus& live, const SettingsHistory& history, GuiItems& items);
  std::string coming_text(const LiveStatus& live, const std::string& footage) const;

  std::string folder_;  ///< of the next take
  bool is_recording_ = false;
  std::int64_t shown_number_ = -1;
  std::deque<std::chrono::steady_clock::time_point> shown_at_;  ///< frames of late
  double latency_ms_ = 0;                                       ///< from having decoded the frame to having shown it
};

}  // namespace catchlight::app
