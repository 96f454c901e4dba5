#include "app/window/picture/object_hand.hpp"

#include <imgui.h>

#include "app/window/picture/hand.hpp"

namespace catchlight::app {

std::string ObjectHand::take_input(const DrawnFrame& frame, const PictureView& view, SettingsHistory& history) {
  end_released(drag_, history);
  const auto place_m = history.now().objects.empty() ? std::nullopt : pointed_place_m(frame, view);
  if (!place_m) return "";
  const ImGuiIO& io = ImGui::GetIO();
  if (!drag_ && view.may_take_hold() && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
    if (history.now().objects[0].matrix)
      return "the scene file places the object by a matrix: give it translation_m, rotation_deg and scale to drag it";
    kind_ = io.KeyShift ? DragKind::turn : io.KeyCtrl ? DragKind::scale : DragKind::move;
    history.end_gesture();
    drag_.emplace(history.now(), 0, kind_, *place_m);
  }
  if (!drag_) return "";
  if (io.MouseDelta.x != 0 || io.MouseDelta.y != 0) history.change(drag_->at(*place_m), drag_->key());
  ImGui::SetTooltip("%s", ObjectDrag::text(history.now(), 0, kind_).c_str());
  return "";
}

}  // namespace catchlight::app
