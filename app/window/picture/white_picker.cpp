#include "app/window/picture/white_picker.hpp"

#include <imgui.h>

#include <cmath>

#include "app/settings/parameters.hpp"
#include "app/window/editing/white_balance.hpp"
#include "app/window/surface/gui_keys.hpp"
#include "catchlight/error.hpp"

namespace catchlight::app {
namespace {

constexpr int kReach_px = 2;  ///< to each side of the pixel that is clicked
constexpr const char* kKey = "exposure.white_balance";

glm::dvec3 balance_at(const DrawnFrame& frame, const glm::dvec2& pixel) {
  if (!frame.image || !frame.light.probe) throw Error("no tag in this frame: go to one in which the object is seen");
  const int x = static_cast<int>(std::lround(pixel.x)), y = static_cast<int>(std::lround(pixel.y));
  const glm::dvec3 light = mean_light(frame.image->rgb(grown({x, y, 1, 1}, kReach_px)), frame.image->color());
  return white_balance_for(light, frame.light.paper, frame.light.black);
}

}  // namespace

std::string WhitePicker::take_input(const DrawnFrame& frame, const PictureView& view, SettingsHistory& history) {
  if (is_key_pressed("escape")) is_armed_ = false;
  if (!is_armed_ || !view.may_take_hold()) return "";
  ImGui::SetTooltip("what is white or grey here? (esc: leave it)");
  if (!ImGui::IsMouseClicked(ImGuiMouseButton_Left)) return "";
  is_armed_ = false;
  try {
    SceneSettings next = history.now();
    set_parameter(next, *find_parameter(kKey), balance_at(frame, view.pointed_px()));
    history.end_gesture();
    history.change(std::move(next), kKey);
    history.end_gesture();
    return std::string(kKey) + " is " + parameter_text(history.now(), *find_parameter(kKey));
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace catchlight::app
