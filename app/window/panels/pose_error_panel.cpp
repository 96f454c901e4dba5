#include "app/window/panels/pose_error_panel.hpp"

#include <imgui.h>

#include <algorithm>

#include "app/window/panels/curve.hpp"
#include "catchlight/util/enum_names.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

constexpr ImU32 kGround = IM_COL32(20, 20, 20, 255), kSure = IM_COL32(150, 170, 200, 255), kOff = IM_COL32(235, 160, 70, 255),
                kHead = IM_COL32(255, 255, 255, 170), kWords = IM_COL32(170, 170, 170, 255);
constexpr float kStates = 6;
using Values = std::vector<std::optional<double>>;

struct Area {
  ImVec2 corner, size;
  double most;  ///< the value at the upper edge

  float x(double share) const { return corner.x + static_cast<float>(share) * size.x; }
  float y(double value) const { return corner.y + size.y * static_cast<float>(1 - std::min(value / most, 1.0)); }
};

void draw_curve(const Values& values, const Area& area, ImU32 color) {
  const Values points = greatest_of_parts(values, static_cast<std::size_t>(area.size.x));
  const auto at = [&](std::size_t i) {
    return ImVec2(area.x((static_cast<double>(i) + 0.5) / static_cast<double>(points.size())), area.y(*points[i]));
  };
  ImDrawList* list = ImGui::GetWindowDrawList();
  for (std::size_t i = 1; i < points.size(); ++i)
    if (points[i] && points[i - 1]) list->AddLine(at(i - 1), at(i), color, 1.5f);
}

ImU32 color_of(TrackState state) {
  if (state == TrackState::lost) return IM_COL32(220, 90, 80, 255);
  return state == TrackState::tracking ? IM_COL32(80, 150, 90, 255) : IM_COL32(230, 170, 60, 255);
}

/// A strip of the states: of frames that share a pixel, the worst.
void draw_states(const std::vector<PoseError>& errors, const Area& area) {
  Values states;
  for (const PoseError& error : errors) states.emplace_back(static_cast<double>(error.state));
  const Values points = greatest_of_parts(states, static_cast<std::size_t>(area.size.x));
  const auto count = static_cast<double>(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double begin = static_cast<double>(i);
    ImGui::GetWindowDrawList()->AddRectFilled({area.x(begin / count), area.corner.y + area.size.y},
                                              {area.x((begin + 1) / count), area.corner.y + area.size.y + kStates},
                                              color_of(static_cast<TrackState>(*points[i])));
  }
}

std::string text_of(const PoseError& error) {
  std::string text = "frame " + std::to_string(error.frame) + ": " + name_of(error.state);
  if (error.state != TrackState::lost) text += ", ±" + fixed_text(error.sigma_px, 3) + " px";
  if (error.off_px)
    text += "; off by " + fixed_text(*error.off_px, 3) + " px, " + fixed_text(*error.off_mm, 2) + " mm, " +
            fixed_text(*error.turned_deg, 3) + "°";
  return text;
}

void draw_legend(bool has_truth) {
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kSure), "± of the corners, by the track");
  if (!has_truth) return;
  ImGui::SameLine();
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kOff), "off the true pose");
}

}  // namespace

void draw_pose_errors(const std::vector<PoseError>& errors, Playhead& playhead, GuiItems& items) {
  if (errors.empty()) return ImGui::TextDisabled("not known before the shot is tracked");
  Values sure, off;
  double most = 1e-3;
  for (const PoseError& error : errors) {
    const bool is_found = error.state != TrackState::lost;
    sure.push_back(is_found ? std::optional(error.sigma_px) : std::nullopt);
    off.push_back(error.off_px);
    if (error.state == TrackState::tracking) most = std::max({most, error.sigma_px, error.off_px.value_or(0)});
  }
  const float height = 8 * ImGui::GetTextLineHeight();
  const Area area{ImGui::GetCursorScreenPos(), {ImGui::GetContentRegionAvail().x, height - kStates}, 1.1 * most};
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(area.corner, {area.corner.x + area.size.x, area.corner.y + area.size.y}, kGround);
  draw_curve(sure, area, kSure);
  draw_curve(off, area, kOff);
  draw_states(errors, area);
  list->AddText({area.corner.x + 4, area.corner.y + 2}, kWords, (fixed_text(area.most, 3) + " px").c_str());
  const auto count = static_cast<double>(errors.size());
  const float head = area.x((static_cast<double>(playhead.position()) + 0.5) / count);
  list->AddLine({head, area.corner.y}, {head, area.corner.y + height}, kHead);
  ImGui::InvisibleButton("pose error curve", {area.size.x, height});
  items.note("pose error curve");
  if (ImGui::IsItemActive()) {
    const double share = (ImGui::GetIO().MousePos.x - area.corner.x) / area.size.x;
    playhead.go_to(static_cast<std::int64_t>(std::clamp(share, 0.0, 1.0) * count));
  }
  draw_legend(std::ranges::any_of(off, [](const auto& value) { return value.has_value(); }));
  const auto at = std::min(static_cast<std::size_t>(playhead.position()), errors.size() - 1);
  ImGui::TextWrapped("%s", text_of(errors[at]).c_str());
}

}  // namespace catchlight::app
