#include "app/window/surface/gui_style.hpp"

#include <imgui.h>

#include <filesystem>

namespace catchlight::app {
namespace {

constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr float kFontSize = 14;

ImVec4 grey(float value, float alpha = 1) {
  return {value, value, value, alpha};
}

}  // namespace

void set_gui_style(float scale) {
  ImGuiIO& io = ImGui::GetIO();
  static constexpr ImWchar kRanges[] = {0x20, 0xff, 0x2013, 0x2026, 0x2190, 0x21ff, 0x2212, 0x2212, 0x25a0, 0x25ff, 0};
  io.Fonts->Clear();
  if (std::filesystem::exists(kFont))
    io.Fonts->AddFontFromFileTTF(kFont, kFontSize * scale, nullptr, kRanges);
  else
    io.FontGlobalScale = scale;
  ImGuiStyle& style = ImGui::GetStyle();
  style = {};  // sizes would be scaled twice
  ImGui::StyleColorsDark();
  style.WindowRounding = style.FrameRounding = style.GrabRounding = 2;
  style.WindowBorderSize = 0;
  style.ItemSpacing = {6, 5};
  ImVec4* colors = style.Colors;
  const ImVec4 accent{0.86f, 0.62f, 0.25f, 1};
  colors[ImGuiCol_WindowBg] = grey(0.13f);
  colors[ImGuiCol_ChildBg] = grey(0.13f);
  colors[ImGuiCol_PopupBg] = grey(0.16f);
  colors[ImGuiCol_FrameBg] = grey(0.20f);
  colors[ImGuiCol_FrameBgHovered] = grey(0.26f);
  colors[ImGuiCol_FrameBgActive] = grey(0.30f);
  colors[ImGuiCol_Button] = grey(0.24f);
  colors[ImGuiCol_ButtonHovered] = grey(0.32f);
  colors[ImGuiCol_ButtonActive] = grey(0.40f);
  colors[ImGuiCol_Header] = grey(0.20f);
  colors[ImGuiCol_HeaderHovered] = grey(0.26f);
  colors[ImGuiCol_HeaderActive] = grey(0.30f);
  colors[ImGuiCol_SliderGrab] = grey(0.42f);
  colors[ImGuiCol_SliderGrabActive] = accent;
  colors[ImGuiCol_CheckMark] = accent;
  colors[ImGuiCol_PlotHistogram] = accent;
  colors[ImGuiCol_TextSelectedBg] = grey(0.40f);
  colors[ImGuiCol_TitleBgActive] = grey(0.16f);
  style.ScaleAllSizes(scale);
}

}  // namespace catchlight::app
