#include "app/window/panels/live_panel.hpp"

#include <imgui.h>

#include <imgui_stdlib.h>

#include <filesystem>

#include "app/window/surface/gui_keys.hpp"
#include "app/window/surface/window_layout.hpp"
#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

using Clock = std::chrono::steady_clock;

/// A camera's frames are never a second apart.
constexpr auto kPatience = std::chrono::seconds(1);

bool is_waiting(const LiveStatus& live) {
  return live.waiting_since && Clock::now() - *live.waiting_since > kPatience;
}

std::string state_of(const LiveStatus& live) {
  if (live.lost) return "lost";
  if (is_waiting(live)) return "waiting";
  return live.source ? "live" : "opening";
}

std::string free_folder() {
  int number = 1;
  while (std::filesystem::exists("take-" + std::to_string(number))) ++number;
  return "take-" + std::to_string(number);
}

std::string take_text(const TakeStatus& take) {
  const std::string frames = counted(take.written, "frame");
  const std::string left_out = take.left_out > 0 ? ", " + std::to_string(take.left_out) + " left out" : "";
  if (take.error) return take.folder + ": " + *take.error;
  if (!take.is_over) return "records to " + take.folder + ": " + frames + left_out;
  return "recorded " + frames + left_out + "; to play: catchlight tune " + take.folder;
}

}  // namespace

LivePanel::LivePanel() : folder_(free_folder()) {}

void LivePanel::note_shown(const DrawnFrame& frame) {
  constexpr auto kWindow = std::chrono::seconds(3);
  if (!frame.image || frame.wish == 0 || frame.number == shown_number_) return;
  const Clock::time_point now = Clock::now();
  latency_ms_ = std::chrono::duration<double, std::milli>(now - frame.image->decoded_at()).count();
  shown_number_ = frame.number;
  shown_at_.push_back(now);
  while (now - shown_at_.front() > kWindow) shown_at_.pop_front();
}

std::string LivePanel::coming_text(const LiveStatus& live, const std::string& footage) const {
  if (live.lost) return *live.lost + (live.has_ended ? "" : "; it is looked for again");
  if (is_waiting(live)) return "waiting for frames from " + footage;
  if (!live.source) return "opening " + footage;
  std::string text = "live";
  if (shown_at_.size() > 1) {
    const double elapsed_s = std::chrono::duration<double>(shown_at_.back() - shown_at_.front()).count();
    text += ": " + fixed_text(static_cast<double>(shown_at_.size() - 1) / elapsed_s, 1) + " /s, " + fixed_text(latency_ms_, 0) +
            " ms behind";
  }
  return text + ", " + std::to_string(live.dropped_frames) + " dropped";
}

std::string LivePanel::draw_take(LiveFeed& feed, const LiveStatus& live, const SettingsHistory& history, GuiItems& items) {
  std::string problem;
  const bool is_going_on = live.take && !live.take->is_over;
  if (is_recording_ && !is_going_on) folder_ = free_folder();
  is_recording_ = is_going_on;
  ImGui::BeginDisabled(!is_going_on && (!live.source || live.lost));
  if (is_going_on) ImGui::PushStyleColor(ImGuiCol_Button, {0.55f, 0.15f, 0.15f, 1});
  const bool is_clicked = ImGui::Button(is_going_on ? "stop" : "record", {3.2f * ImGui::GetFrameHeight(), 0});
  if (is_going_on) ImGui::PopStyleColor();
  ImGui::EndDisabled();
  items.note("record");
  tooltip(is_going_on ? "ends the recording" : "writes footage, camera and scene into the folder, to play again");
  if (is_clicked && is_going_on) feed.end_take();
  if (is_clicked && !is_going_on) try {
      feed.begin_take(folder_, history.now());
    } catch (const Error& error) {
      problem = error.what();
    }
  ImGui::SameLine();
  ImGui::SetNextItemWidth(9 * ImGui::GetFrameHeight());
  ImGui::BeginDisabled(is_going_on);
  ImGui::InputText("##take folder", &folder_);
  ImGui::EndDisabled();
  items.note("take folder");
  ImGui::SameLine();
  if (live.take) ImGui::TextUnformatted(take_text(*live.take).c_str());
  return problem;
}

std::string LivePanel::draw(LiveFeed& feed, const std::string& footage, const SettingsHistory& history, Playhead& playhead,
                            GuiItems& items) {
  const LiveStatus live = feed.status();
  const bool is_clicked = ImGui::Button(playhead.is_playing() ? "||" : "▶", {2.2f * ImGui::GetFrameHeight(), 0});
  items.note("play");
  tooltip("hold the picture, go on (space)");
  if (is_clicked || (!ImGui::GetIO().WantTextInput && is_key_pressed("space"))) playhead.toggle();
  feed.hold(!playhead.is_playing());
  ImGui::SameLine();
  std::string problem = draw_take(feed, live, history, items);
  const ImVec4 color = live.lost          ? ImVec4(1, 0.5f, 0.4f, 1)
                       : is_waiting(live) ? ImVec4(0.95f, 0.7f, 0.3f, 1)
                                          : ImVec4(0.8f, 0.8f, 0.8f, 1);
  const std::string state =
      playhead.is_playing() || live.lost ? coming_text(live, footage) : "held; " + coming_text(live, footage);
  ImGui::TextColored(color, "%s", state.c_str());
  return problem;
}

std::optional<std::string> LivePanel::value_of(const std::string& key, const LiveStatus& live) const {
  if (key == "source") return state_of(live);
  if (key == "latency_ms") return number_text(latency_ms_);
  if (key == "dropped_frames") return std::to_string(live.dropped_frames);
  if (key == "take_frames") return std::to_string(live.take ? live.take->written : 0);
  if (key != "take") return {};
  if (!live.take) return "none";
  return live.take->error ? *live.take->error : live.take->is_over ? "recorded" : "recording";
}

}  // namespace catchlight::app
