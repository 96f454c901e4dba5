#include "app/window/panels/panels.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/window/panels/pose_error_panel.hpp"

namespace catchlight::app {
namespace {

void draw_histogram(const Histogram& histogram) {
  static constexpr ImU32 kColors[] = {IM_COL32(230, 80, 80, 130), IM_COL32(90, 200, 90, 130), IM_COL32(90, 130, 240, 130)};
  const ImVec2 corner = ImGui::GetCursorScreenPos(), size{ImGui::GetContentRegionAvail().x, 6.5f * ImGui::GetFontSize()};
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(corner, {corner.x + size.x, corner.y + size.y}, IM_COL32(20, 20, 20, 255));
  for (std::size_t c = 0; c < 3; ++c) {
    const auto& counts = histogram.counts[c];
    const float most = *std::max_element(counts.begin(), counts.end());
    for (std::size_t code = 0; code < 256 && most > 0; ++code) {
      const float x = corner.x + static_cast<float>(code) / 256 * size.x, height = std::sqrt(counts[code] / most) * size.y;
      list->AddRectFilled({x, corner.y + size.y - height}, {x + size.x / 256, corner.y + size.y}, kColors[c]);
    }
  }
  ImGui::Dummy(size);
}

void draw_times(const std::vector<render::PassTime>& times) {
  double most = 1;
  for (const render::PassTime& pass : times) most = std::max(most, pass.ms);
  for (const render::PassTime& pass : times) {
    char text[64];
    std::snprintf(text, sizeof text, "%s  %.1f ms", pass.name.c_str(), pass.ms);
    ImGui::ProgressBar(static_cast<float>(pass.ms / most), {-1, 0}, text);
  }
}

}  // namespace

Histogram histogram_of(const RgbPicture& picture) {
  Histogram histogram;
  for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3)
    for (std::size_t c = 0; c < 3; ++c) ++histogram.counts[c][picture.rgb[i + c]];
  return histogram;
}

void Panels::draw(const std::shared_ptr<const DrawnFrame>& frame, const PlayerStatus& status, Playhead& playhead,
                  GuiItems& items) {
  if (items.section("histogram") && frame) {
    if (frame != counted_) histogram_ = histogram_of(frame->composite);
    counted_ = frame;
    draw_histogram(histogram_);
  }
  if (items.section("waveform") && frame) waveform_.draw(frame);
  if (items.section("pose error"))
    draw_pose_errors(status.pose_errors ? *status.pose_errors : std::vector<PoseError>{}, playhead, items);
  if (items.section("times") && frame) draw_times(frame->pass_times);
  if (items.section("plan"))
    for (const PlanEntry& entry : status.plan)
      ImGui::TextWrapped("%s = %s: %s", entry.choice.c_str(), entry.value.c_str(), entry.reason.c_str());
  if (items.section("warnings"))
    for (const std::string& warning : status.warnings) ImGui::TextWrapped("%s", warning.c_str());
}

}  // namespace catchlight::app
