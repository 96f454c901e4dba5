// What the pointer does in the picture: it takes hold of the object or of a shadow, or picks a colour.
#pragma once

#include <string>

#include "app/window/picture/object_hand.hpp"
#include "app/window/picture/sun_hand.hpp"
#include "app/window/picture/white_picker.hpp"

namespace catchlight::app {

class PictureHands {
 public:
  /// What to tell the user; empty where there is nothing.
  std::string take_input(const DrawnFrame& frame, const PictureView& view, SettingsHistory& history);

  /// Whether something is held that moves.
  bool holds() const { return object_.holds() || sun_.holds(); }

  WhitePicker white;

 private:
  ObjectHand object_;
  SunHand sun_;
};

}  // namespace catchlight::app
