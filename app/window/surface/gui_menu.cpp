#include "app/window/surface/gui_menu.hpp"

#include <imgui.h>

#include "app/window/surface/window_layout.hpp"

namespace catchlight::app {

bool begin_menu(const std::string& text, const std::string& name, GuiItems& items) {
  fit_button_on_line(text + " ▾");
  if (ImGui::Button((text + " ▾###" + name).c_str())) ImGui::OpenPopup(name.c_str());
  items.note(name);
  const GuiItems::Rect button = *items.find(name);
  ImGui::SetNextWindowPos({button.min.x, button.max.y});
  ImGui::SameLine();
  return ImGui::BeginPopup(name.c_str());
}

}  // namespace catchlight::app
