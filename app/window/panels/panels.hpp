// What the window tells about a frame in figures.
#pragma once

#include <array>
#include <memory>

#include "app/window/panels/waveform_panel.hpp"
#include "app/window/playing/playhead.hpp"
#include "app/window/playing/shot_player.hpp"
#include "app/window/surface/gui_items.hpp"

namespace catchlight::app {

/// How often each 8-bit code is in a picture, a channel each.
struct Histogram {
  std::array<std::array<float, 256>, 3> counts{};
};
Histogram histogram_of(const RgbPicture& picture);

/// Draws the figures into the current ImGui window, a section each.
class Panels {
 public:
  void draw(const std::shared_ptr<const DrawnFrame>& frame, const PlayerStatus& status, Playhead& playhead, GuiItems& items);

 private:
  std::shared_ptr<const DrawnFrame> counted_;
  Histogram histogram_;
  WaveformPanel waveform_;
};

}  // namespace catchlight::app
