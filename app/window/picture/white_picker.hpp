// The eyedropper: what is clicked in the picture should be white or grey.
#pragma once

#include <string>

#include "app/window/editing/settings_history.hpp"
#include "app/window/picture/picture_view.hpp"
#include "app/window/playing/shot_player.hpp"

namespace catchlight::app {

class WhitePicker {
 public:
  /// The next click in the picture sets the balance; asked again, it does not.
  void toggle() { is_armed_ = !is_armed_; }
  bool is_armed() const { return is_armed_; }

  /// Takes a click in the footage's picture for exposure.white_balance. What to tell the user; empty where there is nothing.
  std::string take_input(const DrawnFrame& frame, const PictureView& view, SettingsHistory& history);

 private:
  bool is_armed_ = false;
};

}  // namespace catchlight::app
