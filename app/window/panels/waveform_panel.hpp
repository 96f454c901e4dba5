// The composite's waveform: luma, and red, green and blue side by side.
#pragma once

#include <memory>

#include "app/window/playing/shot_player.hpp"
#include "render/gl/gl_objects.hpp"

namespace catchlight::app {

class WaveformPanel {
 public:
  /// Draws it into the current ImGui window; counts only where the frame is another than the last.
  void draw(const std::shared_ptr<const DrawnFrame>& frame);

 private:
  void count(const DrawnFrame& frame);

  std::shared_ptr<const DrawnFrame> counted_;
  render::GlTexture luma_, parade_;
};

}  // namespace catchlight::app
