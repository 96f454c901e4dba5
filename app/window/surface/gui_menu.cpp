#include "app/window/surface/gui_menu.hpp"

#include <imgui.h>

namespace catchlight::app {

bool begin_menu(const std::string& text, const std::string& name, GuiItems& items) {
  if (ImGui::Button((text + " ▾###" + name).c_str())) ImGui::OpenPopup(name.c_str());
  items.note(name);
  const GuiItems::Rect button = *items.find(name);
  ImGui::SetNextWindowPos({button.min.x, button.max.y});
  ImGui::SameLine();
  return ImGui::BeginPopup(name.c_str());
}

}  // namespace catchlight::app
