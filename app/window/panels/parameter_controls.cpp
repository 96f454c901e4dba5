#include "app/window/panels/parameter_controls.hpp"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>

#include "app/settings/parameters.hpp"
#include "app/window/panels/effect_switches.hpp"
#include "app/window/surface/window_layout.hpp"
#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

/// What a control was turned to.
using Turned = std::optional<ParameterValue>;

/// Sliders over more than this would be too coarse: such values are dragged instead, in steps of a thousandth of a unit.
constexpr double kMaxSliderRange = 720;

Turned draw_real(const RealKind& kind, const SceneSettings& settings, std::size_t index) {
  double value = kind.access(settings, index);
  const bool is_logarithmic = kind.scale == Scale::logarithmic;
  const char* format = kind.scale == Scale::angle ? "%.2f°" : "%.4g";
  bool is_turned;
  if (kind.max - kind.min > kMaxSliderRange && !is_logarithmic)
    is_turned = ImGui::DragScalar("##value", ImGuiDataType_Double, &value, 0.001f, &kind.min, &kind.max, format);
  else
    is_turned = ImGui::SliderScalar("##value", ImGuiDataType_Double, &value, &kind.min, &kind.max, format,
                                    is_logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
  return is_turned ? Turned(std::clamp(value, kind.min, kind.max)) : Turned();
}

Turned draw_integer(const IntegerKind& kind, const SceneSettings& settings, std::size_t index) {
  int value = kind.access(settings, index);
  bool is_turned;
  if (kind.max - kind.min > static_cast<int>(kMaxSliderRange) && kind.scale != Scale::logarithmic)
    is_turned = ImGui::InputInt("##value", &value, 1, 10, ImGuiInputTextFlags_EnterReturnsTrue);
  else
    is_turned = ImGui::SliderInt("##value", &value, kind.min, kind.max, "%d",
                                 kind.scale == Scale::logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
  return is_turned ? Turned(std::int64_t{std::clamp(value, kind.min, kind.max)}) : Turned();
}

Turned draw_vector(const VectorKind& kind, const SceneSettings& settings, std::size_t index) {
  const glm::dvec3 held = kind.access(settings, index);
  if (kind.scale == Scale::color) {
    float color[3] = {static_cast<float>(held.x), static_cast<float>(held.y), static_cast<float>(held.z)};
    if (!ImGui::ColorEdit3("##value", color, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR)) return {};
    return glm::clamp(glm::dvec3(color[0], color[1], color[2]), kind.min, kind.max);
  }
  double value[3] = {held.x, held.y, held.z};
  const float speed = kind.scale == Scale::angle ? 0.5f : 0.0005f;
  if (!ImGui::DragScalarN("##value", ImGuiDataType_Double, value, 3, speed, &kind.min, &kind.max, "%.4g")) return {};
  return glm::clamp(glm::dvec3(value[0], value[1], value[2]), kind.min, kind.max);
}

/// Scripts click a choice of the open list by the row's name with the choice: "probe.up y".
Turned draw_choice(const std::vector<std::string>& choices, const std::string& held, const std::string& name, GuiItems& items) {
  Turned turned;
  if (!ImGui::BeginCombo("##value", held.c_str())) return turned;
  for (const std::string& choice : choices) {
    if (ImGui::Selectable(choice.c_str(), choice == held)) turned = choice;
    items.note((name + ' ').append(choice));
  }
  ImGui::EndCombo();
  return turned;
}

Turned draw_switch(const SwitchKind& kind, const SceneSettings& settings, std::size_t index, const std::string& name,
                   GuiItems& items) {
  static const std::vector<std::string> choices{"auto", "off", "on"};
  const std::size_t held = static_cast<std::size_t>(kind.access(settings, index));
  const Turned turned = draw_choice(choices, choices[held], name, items);
  if (!turned) return {};
  const std::string& word = std::get<std::string>(*turned);
  return word == "auto" ? ParameterValue(word) : ParameterValue(word == "on");
}

Turned draw_path(const PathKind& kind, const SceneSettings& settings, std::size_t index) {
  std::string path = kind.access(settings, index);
  const bool is_entered = ImGui::InputText("##value", &path, ImGuiInputTextFlags_EnterReturnsTrue);
  return is_entered ? Turned(path) : Turned();
}

Turned draw_flag(const FlagKind& kind, const SceneSettings& settings, std::size_t index) {
  bool value = kind.access(settings, index);
  return ImGui::Checkbox("##value", &value) ? Turned(value) : Turned();
}

Turned draw_value(const Parameter& parameter, const SceneSettings& settings, std::size_t index, const std::string& name,
                  GuiItems& items) {
  struct Visitor {
    const SceneSettings& settings;
    std::size_t index;
    const std::string& name;
    GuiItems& items;
    Turned operator()(const RealKind& kind) const { return draw_real(kind, settings, index); }
    Turned operator()(const IntegerKind& kind) const { return draw_integer(kind, settings, index); }
    Turned operator()(const FlagKind& kind) const { return draw_flag(kind, settings, index); }
    Turned operator()(const SwitchKind& kind) const { return draw_switch(kind, settings, index, name, items); }
    Turned operator()(const VectorKind& kind) const { return draw_vector(kind, settings, index); }
    Turned operator()(const PathKind& kind) const { return draw_path(kind, settings, index); }
    Turned operator()(const WordKind& kind) const { return draw_choice(kind.choices, kind.access(settings, index), name, items); }
    Turned operator()(const ChoiceKind& kind) const { return draw_choice(kind.choices, kind.held(settings, index), name, items); }
  };
  return std::visit(Visitor{settings, index, name, items}, parameter.kind);
}

bool holds_text(const std::string& text, const std::string& part) {
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
}

bool is_as_in(const SceneSettings& file, const SceneSettings& now, const Parameter& parameter, std::size_t index) {
  return parameter_text(file, parameter, index) == parameter_text(now, parameter, index);
}

/// What stands before a control: the key within its section, with the element's number where there are several, without the
/// names of frames, which are in the tooltip and would push the words that differ out of the column.
std::string row_label(const std::string& name) {
  const std::size_t bracket = name.find('['), dot = name.find('.');
  const std::string element = bracket < dot ? name.substr(bracket, dot - bracket) + ' ' : "";
  std::string key = name.substr(dot + 1);
  for (const std::string_view frames : {"tag_from_object.", "tag_from_this."})
    if (key.starts_with(frames)) key.erase(0, frames.size());
  return element + key;
}

/// Behind a name, in so much room: a clock where a change takes more than a moment, with what the last one took; bright while
/// that is being redone.
void draw_cost(ChangeCost cost, const PlayerStatus& status, float room) {
  constexpr double kMoment_s = 0.3;
  const auto took = status.took_s.find(cost);
  const bool is_known = took != status.took_s.end();
  if (cost < ChangeCost::light || (is_known && took->second < kMoment_s)) return;
  const std::string seconds = is_known ? fixed_text(took->second, 1) + " s" : "";
  for (const std::string& text : {"◔ " + seconds, std::string("◔")}) {
    const float spacing = ImGui::GetStyle().ItemSpacing.x, width = ImGui::CalcTextSize(text.c_str()).x;
    if (width + 2 * spacing > room) continue;
    ImGui::SameLine(0, room - width - spacing);
    ImGui::TextColored(status.redoing == cost ? ImVec4(0.95f, 0.70f, 0.30f, 1) : ImVec4(0.45f, 0.45f, 0.45f, 1), "%s",
                       text.c_str());
    return tooltip("A change redoes more than the frame: " + name_of(cost) + (is_known ? ", the last in " + seconds : "") + ".");
  }
}

}  // namespace

/// Brings the file's value back.
void ParameterControls::draw_reset(const Parameter& parameter, std::size_t index, const std::string& name,
                                   SettingsHistory& history, GuiItems& items) {
  const std::string text = parameter_text(history.file(), parameter, index);
  ImGui::SameLine();
  if (ImGui::Button("↺", {ImGui::GetFrameHeight(), 0})) {
    SceneSettings next = history.now();
    if (std::holds_alternative<PathKind>(parameter.kind))
      set_parameter(next, parameter, text, index);  // as the file has it: an option's path would start at the working folder
    else
      set_parameter_from_text(next, name, text);
    if (!history.file().is_by_hand(parameter.key)) next.by_hand.erase(parameter.key);
    history.end_gesture();
    history.change(std::move(next), name);
    history.end_gesture();
  }
  items.note(name + " reset");
  tooltip("back to " + text);
}

void ParameterControls::draw_row(const Parameter& parameter, std::size_t index, SettingsHistory& history,
                                 const PlayerStatus& status, GuiItems& items) {
  const SceneSettings& now = history.now();
  const std::string name = element_count(now, parameter) < 2 ? parameter.key : element_key(parameter, index);
  ImGui::PushID(name.c_str());
  const bool is_changed = !is_as_in(history.file(), now, parameter, index);
  const auto change = [&](const ParameterValue& value) {
    SceneSettings next = now;
    try {
      set_parameter(next, parameter, value, index);
      refused_.clear();
      history.change(std::move(next), name);
    } catch (const Error& error) {
      refused_ = error.what();
    }
  };
  ImGui::AlignTextToFramePadding();
  ImGui::TextColored(is_changed ? ImVec4(0.95f, 0.70f, 0.30f, 1) : ImVec4(0.80f, 0.80f, 0.80f, 1), "%s", row_label(name).c_str());
  const float name_width = ImGui::GetItemRectSize().x;
  tooltip(name + "\n" + parameter.help + "\n" + expected_text(parameter) + "\nA change costs: " + name_of(parameter.cost) + ".");
  const float column = ImGui::GetContentRegionAvail().x * 0.44f;
  draw_cost(parameter.cost, status, column - name_width - ImGui::GetStyle().WindowPadding.x);
  ImGui::SameLine(column);
  ImGui::SetNextItemWidth(is_changed ? -ImGui::GetFrameHeight() - ImGui::GetStyle().ItemSpacing.x : -1);
  if (const Turned turned = draw_value(parameter, now, index, name, items)) change(*turned);
  items.note(name);
  if (ImGui::IsItemDeactivatedAfterEdit()) history.end_gesture();
  if (is_changed) draw_reset(parameter, index, name, history, items);
  ImGui::PopID();
}

void ParameterControls::draw(SettingsHistory& history, const PlayerStatus& status, GuiItems& items) {
  ImGui::SetNextItemWidth(-1);
  ImGui::InputTextWithHint("##search", "search parameters", &search_);
  items.note("search");
  if (!refused_.empty()) ImGui::TextWrapped("%s", refused_.c_str());
  if (search_.empty()) draw_effect_switches(history, items);
  std::string group;
  bool is_open = false;
  for (const Parameter& parameter : parameters()) {
    if (!search_.empty() && !holds_text(parameter.key, search_) && !holds_text(parameter.help, search_)) continue;
    const std::string group_here = parameter.key.substr(0, parameter.key.find('.'));
    if (group_here != group) {
      group = group_here;
      is_open = items.section(group.c_str(), !search_.empty());
    }
    if (!is_open) continue;
    const std::size_t count = element_count(history.now(), parameter);
    for (std::size_t i = 0; i < count; ++i) draw_row(parameter, i, history, status, items);
  }
}

}  // namespace catchlight::app
