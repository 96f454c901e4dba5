// The hand on the object: it is moved, turned and scaled in the picture.
#pragma once

#include <optional>
#include <string>

#include "app/window/editing/object_drag.hpp"
#include "app/window/editing/settings_history.hpp"
#include "app/window/picture/picture_view.hpp"
#include "app/window/playing/shot_player.hpp"

namespace catchlight::app {

class ObjectHand {
 public:
  /// The left button takes hold of the first object: it moves, with shift it turns, with ctrl it grows. What to tell the user;
  /// empty where there is nothing.
  std::string take_input(const DrawnFrame& frame, const PictureView& view, SettingsHistory& history);

  bool holds() const { return drag_.has_value(); }

 private:
  std::optional<ObjectDrag> drag_;
  DragKind kind_ = DragKind::move;
};

}  // namespace catchlight::app
