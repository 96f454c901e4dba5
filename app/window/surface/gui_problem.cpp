#include "app/window/surface/gui_problem.hpp"

#include <imgui.h>

#include <algorithm>

namespace catchlight::app {

void draw_problem(const std::string& text) {
  const ImVec2 corner = ImGui::GetWindowPos(), size = ImGui::GetWindowSize(), padding = ImGui::GetStyle().WindowPadding;
  const float width = size.x - 2 * padding.x;
  const float height = std::min(ImGui::CalcTextSize(text.c_str(), nullptr, false, width).y, size.y - 2 * padding.y);
  const ImVec2 bottom{corner.x + size.x, corner.y + size.y}, top{corner.x, bottom.y - height - 2 * padding.y};
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->PushClipRect(top, bottom);
  list->AddRectFilled(top, bottom, IM_COL32(50, 18, 14, 235));
  list->AddText(ImGui::GetFont(), ImGui::GetFontSize(), {top.x + padding.x, top.y + padding.y}, IM_COL32(255, 190, 175, 255),
                text.c_str(), nullptr, width);
  list->PopClipRect();
}

}  // namespace catchlight::app
