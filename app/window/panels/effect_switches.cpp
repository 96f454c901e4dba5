#include "app/window/panels/effect_switches.hpp"

#include <imgui.h>

#include <algorithm>
#include <optional>
#include <variant>

#include "app/settings/parameters.hpp"

namespace catchlight::app {
namespace {

/// The values of an effect's row, as options write them.
struct OnAndOff {
  std::string on, off;
};

/// How the tag is found is no effect.
std::optional<OnAndOff> on_and_off(const Parameter& parameter) {
  if (parameter.cost == ChangeCost::track) return {};
  if (std::holds_alternative<SwitchKind>(parameter.kind)) return OnAndOff{"auto", "false"};
  if (std::holds_alternative<FlagKind>(parameter.kind)) return OnAndOff{"true", "false"};
  const auto* choice = std::get_if<ChoiceKind>(&parameter.kind);
  if (!choice || std::ranges::count(choice->choices, "none") == 0) return {};
  return OnAndOff{*std::ranges::find_if(choice->choices, [](const std::string& c) { return c != "none"; }), "none"};
}

/// A switch says its name itself; others stand for their section.
std::string label_of(const Parameter& parameter) {
  const std::size_t dot = parameter.key.find('.');
  const bool is_switch = std::holds_alternative<SwitchKind>(parameter.kind);
  std::string label = is_switch ? parameter.key.substr(dot + 1) : parameter.key.substr(0, dot);
  std::ranges::replace(label, '_', ' ');
  return label;
}

void draw_switch(const Parameter& parameter, const OnAndOff& values, SettingsHistory& history, GuiItems& items) {
  const std::string label = label_of(parameter), held = parameter_text(history.now(), parameter);
  bool is_on = held != values.off;
  if (ImGui::Checkbox(label.c_str(), &is_on)) {
    const std::string in_file = parameter_text(history.file(), parameter);
    SceneSettings next = history.now();
    set_parameter_from_text(next, parameter.key, !is_on ? values.off : in_file != values.off ? in_file : values.on);
    if (is_on && in_file != values.off && !history.file().is_by_hand(parameter.key)) next.by_hand.erase(parameter.key);
    history.end_gesture();
    history.change(std::move(next), parameter.key);
    history.end_gesture();
  }
  items.note("effect " + label);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s is %s\n%s", parameter.key.c_str(), held.c_str(), parameter.help.c_str());
}

}  // namespace

void draw_effect_switches(SettingsHistory& history, GuiItems& items) {
  if (!items.section("effects") || !ImGui::BeginTable("effects", 2)) return;
  for (const Parameter& parameter : parameters())
    if (const auto values = on_and_off(parameter)) {
      ImGui::TableNextColumn();
      draw_switch(parameter, *values, history, items);
    }
  ImGui::EndTable();
}

}  // namespace catchlight::app
