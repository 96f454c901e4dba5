#include "app/window/surface/gui_items.hpp"

namespace catchlight::app {

bool GuiItems::section(const char* name, bool shows_all) {
  const bool was_open = open_sections.contains(name);
  ImGui::SetNextItemOpen(shows_all || was_open);
  const bool is_open = ImGui::CollapsingHeader(name);
  note(name);
  if (!shows_all && is_open != was_open) is_open ? void(open_sections.insert(name)) : void(open_sections.erase(name));
  return is_open || shows_all;
}

}  // namespace catchlight::app
