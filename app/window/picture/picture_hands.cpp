#include "app/window/picture/picture_hands.hpp"

namespace catchlight::app {

std::string PictureHands::take_input(const DrawnFrame& frame, const PictureView& view, SettingsHistory& history) {
  if (white.is_armed()) return white.take_input(frame, view, history);
  if (sun_.holds() || (SunHand::is_wanted() && !object_.holds())) return sun_.take_input(frame, view, history);
  return object_.take_input(frame, view, history);
}

}  // namespace catchlight::app
