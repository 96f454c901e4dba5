#include "app/window/surface/window_layout.hpp"

#include <algorithm>

namespace catchlight::app {
namespace {

// In units.
constexpr float kMinTop = 34, kMinBottom = 96, kEdge = 5, kMinSide = 260, kMinPicture = 240;

/// As high as what was drawn into it.
float content_height() {
  return ImGui::GetCursorPosY() - ImGui::GetStyle().ItemSpacing.y + ImGui::GetStyle().WindowPadding.y;
}

}  // namespace

void WindowLayout::begin_frame(float scale, bool has_side) {
  size_ = ImGui::GetIO().DisplaySize;
  scale_ = scale;
  has_side_ = has_side;
  top_px_ = std::max(top_px_, kMinTop * scale_);
  bottom_px_ = std::max(bottom_px_, kMinBottom * scale_);
}

float WindowLayout::edge_px() const {
  return has_side_ ? kEdge * scale_ : 0;
}

float WindowLayout::side_px() const {
  if (!has_side_) return 0;
  const float widest = std::max(size_.x / scale_ - kMinPicture, kMinSide);
  return std::clamp(side_width, kMinSide, widest) * scale_;
}

void WindowLayout::begin(const char* name, const Part& part, ImGuiWindowFlags flags) {
  ImGui::SetNextWindowPos({part.x, part.y});
  ImGui::SetNextWindowSize({part.width, part.height});
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | flags);
}

void WindowLayout::begin_top() {
  begin("top", {0, 0, size_.x, top_px_});
}

void WindowLayout::end_top() {
  ImGui::NewLine();  // controls of a row leave the cursor behind the last one
  top_px_ = content_height();
  ImGui::End();
}

void WindowLayout::begin_bottom() {
  begin("bottom", {0, size_.y - bottom_px_, main_px(), bottom_px_});
}

void WindowLayout::end_bottom() {
  bottom_px_ = content_height();
  ImGui::End();
}

void WindowLayout::begin_picture() {
  ImGui::PushStyleColor(ImGuiCol_WindowBg, ImVec4(0.09f, 0.09f, 0.09f, 1));
  begin("picture", {0, top_px_, main_px(), size_.y - top_px_ - bottom_px_}, ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleColor();
}

void WindowLayout::begin_side() {
  begin("side", {size_.x - side_px(), top_px_, side_px(), size_.y - top_px_}, ImGuiWindowFlags_AlwaysVerticalScrollbar);
}

void WindowLayout::draw_edge(GuiItems& items) {
  const float width = edge_px(), height = size_.y - top_px_;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  begin("edge", {size_.x - side_px() - width, top_px_, width, height});
  ImGui::PopStyleVar(2);
  ImGui::InvisibleButton("side-edge", {width, height});
  items.note("side-edge");
  if (ImGui::IsItemActive()) {
    const float wanted_px = size_.x - ImGui::GetIO().MousePos.x - 0.5f * width;
    side_width = wanted_px / scale_;
    side_width = side_px() / scale_;
  }
  const bool is_held = ImGui::IsItemActive() || ImGui::IsItemHovered();
  if (is_held) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  const ImVec2 min = ImGui::GetItemRectMin(), max = ImGui::GetItemRectMax();
  ImGui::GetWindowDrawList()->AddRectFilled(min, max, is_held ? IM_COL32(90, 90, 90, 255) : IM_COL32(16, 16, 16, 255));
  ImGui::End();
}

void fit_on_line(float width_px) {
  if (ImGui::GetContentRegionAvail().x < width_px) ImGui::NewLine();
}

void fit_button_on_line(const std::string& text) {
  fit_on_line(ImGui::CalcTextSize(text.c_str()).x + 2 * ImGui::GetStyle().FramePadding.x);
}

void fit_box_on_line(const std::string& text) {
  fit_on_line(ImGui::CalcTextSize(text.c_str()).x + ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x);
}

void tooltip(const std::string& text) {
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(28 * ImGui::GetFontSize());
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

}  // namespace catchlight::app
