#include "app/window/playing/transport.hpp"

#include <imgui.h>

#include <algorithm>
#include <string>

#include "app/window/surface/gui_keys.hpp"
#include "app/window/surface/window_layout.hpp"
#include "catchlight/util/enum_names.hpp"

namespace catchlight::app {

namespace {

void take_keys(Playhead& playhead) {
  if (ImGui::GetIO().WantTextInput) return;
  if (is_key_pressed("space")) playhead.toggle();
  if (is_key_pressed("left")) playhead.step(-1);
  if (is_key_pressed("right")) playhead.step(1);
  if (is_key_pressed("home")) playhead.step(playhead.begin() - playhead.position());
  if (is_key_pressed("end")) playhead.step(playhead.end() - 1 - playhead.position());
  if (is_key_pressed("[")) playhead.mark_begin();
  if (is_key_pressed("]")) playhead.mark_end();
}

bool button(const char* text, const char* name, const char* help, GuiItems& items) {
  fit_on_line(2.2f * ImGui::GetFrameHeight());
  const bool is_clicked = ImGui::Button(text, {2.2f * ImGui::GetFrameHeight(), 0});
  items.note(name);
  tooltip(help);
  ImGui::SameLine();
  return is_clicked;
}

}  // namespace

void draw_transport(Playhead& playhead, std::int64_t frame_number, double time_s, GuiItems& items) {
  take_keys(playhead);
  if (button("|<", "first", "first frame (home)", items)) playhead.step(playhead.begin() - playhead.position());
  if (button("<", "back", "one frame back (left)", items)) playhead.step(-1);
  if (button(playhead.is_playing() ? "||" : "▶", "play", "play or pause (space)", items)) playhead.toggle();
  if (button(">", "forward", "one frame on (right)", items)) playhead.step(1);
  if (button(">|", "last", "last frame (end)", items)) playhead.step(playhead.end() - 1 - playhead.position());
  fit_on_line(5 * ImGui::GetFrameHeight());
  ImGui::SetNextItemWidth(5 * ImGui::GetFrameHeight());
  if (ImGui::BeginCombo("##mode", name_of(playhead.mode).c_str())) {
    for (const std::string& name : name_list<PlayMode>()) {
      if (ImGui::Selectable(name.c_str(), name == name_of(playhead.mode))) playhead.mode = *value_named<PlayMode>(name);
      items.note("mode " + name);
    }
    ImGui::EndCombo();
  }
  items.note("mode");
  ImGui::SameLine();
  if (button("[", "mark begin", "the range begins here ([)", items)) playhead.mark_begin();
  if (button("]", "mark end", "the range ends here (])", items)) playhead.mark_end();
  if (button("x", "clear marks", "play all", items)) playhead.clear_marks();
  fit_on_line(8 * ImGui::GetFontSize());
  ImGui::AlignTextToFramePadding();
  ImGui::Text("frame %lld   %.3f s", static_cast<long long>(frame_number), time_s);
  std::int64_t position = playhead.position();
  const std::int64_t first = 0, last = std::max(playhead.frame_count() - 1, std::int64_t{0});
  ImGui::SetNextItemWidth(-1);
  if (ImGui::SliderScalar("##timeline", ImGuiDataType_S64, &position, &first, &last, "%lld"))
    playhead.step(position - playhead.position());
  items.note("timeline");
}

}  // namespace catchlight::app
