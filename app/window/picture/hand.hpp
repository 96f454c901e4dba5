// What all hands on the picture do.
#pragma once

#include <imgui.h>

#include <glm/glm.hpp>
#include <optional>

#include "app/window/editing/object_drag.hpp"
#include "app/window/editing/settings_history.hpp"
#include "app/window/picture/picture_view.hpp"
#include "app/window/playing/shot_player.hpp"

namespace catchlight::app {

/// Ends a drag once the left button is released.
template <class Drag>
void end_released(std::optional<Drag>& drag, SettingsHistory& history) {
  if (!drag || ImGui::IsMouseDown(ImGuiMouseButton_Left)) return;
  drag.reset();
  history.end_gesture();
}

/// The place of the tag's plane that the pointer is over (tag x, y); empty where the frame shows none there, or has no pose.
inline std::optional<glm::dvec2> pointed_place_m(const DrawnFrame& frame, const PictureView& view) {
  if (!frame.track.found) return {};
  return seen_place_m(frame.camera, frame.track.camera_from_tag, view.pointed_px());
}

}  // namespace catchlight::app
