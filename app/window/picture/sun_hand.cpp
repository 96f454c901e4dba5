#include "app/window/picture/sun_hand.hpp"

#include <imgui.h>

#include "app/session/scene_files.hpp"
#include "app/window/editing/object_drag.hpp"
#include "app/window/picture/hand.hpp"
#include "app/window/surface/gui_keys.hpp"

namespace catchlight::app {
namespace {

/// Empty where no light of the probe shines on the tag's plane.
std::optional<ShadowDrag> drag_of(const DrawnFrame& frame, const SceneSettings& settings) {
  if (!frame.light.probe) return {};
  const LightOrientation orientation = light_orientation(settings.probe);
  const glm::dmat3 tag_from_light = orientation.tag_from_light(frame.track.camera_from_tag.rotation);
  const render::LightSummary* sun = strongest_light(frame.light.probe->lights, tag_from_light);
  if (!sun) return {};
  const glm::dvec3 up = tag_from_light * orientation.light_from_probe * glm::dvec3(0, 1, 0);
  const glm::dvec2 foot_m(settings.objects[0].tag_from_object()[3]);
  return ShadowDrag(settings, tag_from_light * sun->direction, up, foot_m);
}

}  // namespace

bool SunHand::is_wanted() {
  return ImGui::GetIO().KeyAlt || is_key_down("l");
}

std::string SunHand::take_input(const DrawnFrame& frame, const PictureView& view, SettingsHistory& history) {
  end_released(drag_, history);
  const auto place_m = history.now().objects.empty() ? std::nullopt : pointed_place_m(frame, view);
  if (!place_m) return "";
  if (!drag_ && is_wanted() && view.may_take_hold() && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
    drag_ = drag_of(frame, history.now());
    if (!drag_) return "no light of the probe throws a shadow here that could be dragged";
    history.end_gesture();
  }
  if (!drag_) return "";
  const ImVec2& moved = ImGui::GetIO().MouseDelta;
  if (moved.x != 0 || moved.y != 0) history.change(drag_->at(*place_m), "probe.yaw_deg");
  ImGui::SetTooltip("yaw %.1f°", history.now().probe.yaw_deg);
  return "";
}

}  // namespace catchlight::app
