// How often the window is drawn: on input, and when what it shows changes.
#pragma once

namespace catchlight::app {

class GuiPace {
 public:
  /// How long the window may rest after the frame that was just drawn. `changes_s`: so long it looks the same by itself.
  double rest_s(double changes_s);

 private:
  /// What ImGui does about input is seen a frame or two later: menus open, tooltips are laid out.
  static constexpr int kFramesAfterInput = 3;
  int frames_due_ = kFramesAfterInput;
};

}  // namespace catchlight::app
