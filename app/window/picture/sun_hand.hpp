// The hand on the shadow of the strongest light: it turns the probe.
#pragma once

#include <optional>
#include <string>

#include "app/window/editing/light_drag.hpp"
#include "app/window/editing/settings_history.hpp"
#include "app/window/picture/picture_view.hpp"
#include "app/window/playing/shot_player.hpp"

namespace catchlight::app {

class SunHand {
 public:
  /// Whether the left button takes hold of the shadow now, and of nothing else: l or alt is held.
  static bool is_wanted();

  /// The shadow of the strongest light follows the pointer around the first object's foot. What to tell the user; empty where
  /// there is nothing.
  std::string take_input(const DrawnFrame& frame, const PictureView& view, SettingsHistory& history);

  bool holds() const { return drag_.has_value(); }

 private:
  std::optional<ShadowDrag> drag_;
};

}  // namespace catchlight::app
