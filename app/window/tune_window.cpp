#include "app/window/tune_window.hpp"

#include <imgui.h>

#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgproc.hpp>

#include "app/settings/change_cost.hpp"
#include "app/settings/parameters.hpp"
#include "app/settings/scene_file_edit.hpp"
#include "app/window/picture/view_choice.hpp"
#include "app/window/start/dropped_file.hpp"
#include "app/window/surface/gui_keys.hpp"
#include "app/window/surface/gui_menu.hpp"
#include "app/window/surface/gui_problem.hpp"
#include "catchlight/error.hpp"
#include "render/image/picture_file.hpp"

namespace catchlight::app {
namespace {

constexpr std::array<std::array<const char*, 2>, 13> kHelp{{
    {"space", "play, pause"},
    {"left, right", "one frame back, on"},
    {"home, end", "first, last frame"},
    {"[ and ]", "mark the range that plays"},
    {"left button", "moves the object; with shift turns, with ctrl scales it"},
    {"l + left button", "turns the probe by its shadow (alt does, too)"},
    {"w", "white balance: then click something white or grey"},
    {"wheel", "zoom; middle button moves the picture"},
    {"f and 1", "the whole picture, pixel by pixel"},
    {"a and b", "flip to settings A, B; with shift, keep them"},
    {"ctrl+z, ctrl+y", "undo, redo"},
    {"ctrl+s", "save the scene file"},
    {"f1", "these keys"},
}};

void write_picture(const std::string& path, const RgbPicture& picture) {
  const cv::Mat rgb(picture.height, picture.width, CV_8UC3, const_cast<unsigned char*>(picture.rgb.data()));
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  render::write_png(path, bgr);
}

}  // namespace

TuneWindow::TuneWindow(GuiSurface& surface, const OpenedRecording& wanted, TuneState state)
    : surface_(surface), opened_{"", wanted.overrides}, state_(std::move(state)) {
  layout_.side_width = state_.side_width;
  items_.open_sections = state_.open_sections;
  if (!wanted.location.empty()) open(wanted);
}

TuneState TuneWindow::state() const {
  TuneState state = state_;
  const ImVec2 size_px = ImGui::GetIO().DisplaySize;
  state.width = static_cast<int>(std::lround(size_px.x / surface_.scale()));
  state.height = static_cast<int>(std::lround(size_px.y / surface_.scale()));
  state.side_width = layout_.side_width;
  state.open_sections = items_.open_sections;
  return state;
}

void TuneWindow::open(const OpenedRecording& wanted) {
  Recording recording = open_recording(wanted.location, wanted.overrides);  // where this throws, all is as before
  player_.reset();
  recording_ = recording;
  opened_ = wanted;
  state_.remember(wanted.location);
  message_.clear();
  history_.emplace(recording.scene);
  playhead_ = {};
  shown_ = nullptr;
  wished_.reset();
  player_ = std::make_unique<ShotPlayer>(std::move(recording), [&surface = surface_] { surface.wake(); });
  if (is_live()) playhead_.toggle();
  surface_.set_title(recording_->name + " – Catchlight");
}

std::string TuneWindow::scene_file() const {
  if (opened_.overrides.scene_file) return *opened_.overrides.scene_file;
  return (std::filesystem::path(recording_->folder) / "scene.toml").string();
}

void TuneWindow::set(const std::string& key, const std::string& text) {
  if (!history_) throw Error("set " + key + ": no recording is open");
  SceneSettings next = history_->now();
  set_parameter_from_text(next, key, text);
  history_->end_gesture();
  history_->change(std::move(next), key);
  history_->end_gesture();
}

std::string TuneWindow::value_of(const std::string& key) const {
  if (key == "stage") return player_ ? player_->status().stage : "";
  if (key == "error") return player_ ? player_->status().error.value_or("none") : "none";
  if (key == "frame") return std::to_string(is_live() && shown_ ? shown_->number : playhead_.position());
  if (key == "message") return message();
  if (key == "bake") return !shown_ || shown_->wish == 0 ? "none" : shown_->rung == Rung::rough ? "rough" : "full";
  if (key == "tag") return shown_ && shown_->track.found ? "found" : "lost";
  if (is_live())
    if (const auto value = live_panel_.value_of(key, player_->live()->status())) return *value;
  const Parameter* parameter = find_parameter(key);
  return parameter && history_ ? parameter_text(history_->now(), *parameter) : "unknown";
}

void TuneWindow::picture(const std::string& path) {
  if (!shown_) throw Error("picture " + path + ": nothing is shown yet");
  write_picture(path, shown_->composite);
}

bool TuneWindow::write_scene(const std::string& to) {
  try {
    const auto folder = [](const std::string& file) {
      return std::filesystem::weakly_canonical(std::filesystem::absolute(file).parent_path());
    };
    if (folder(scene_file()) != folder(to))
      throw Error(to + ": the scene's paths start from its own folder; expected a file in " + folder(scene_file()).string());
    save_scene_file(scene_file(), to, history_->file(), history_->now());
    message_ = "saved " + to;
    return true;
  } catch (const Error& error) {
    message_ = error.what();
    return false;
  }
}

/// What is to be seen now.
FrameWish TuneWindow::wanted() const {
  const bool is_turned = hands_.holds() || ImGui::IsAnyItemActive();
  return {history_->now(), playhead_.position(), playhead_.is_playing() || is_turned, picture_view_.wanted()};
}

/// Whether the player was not asked for that yet.
bool TuneWindow::is_new(const FrameWish& wish) const {
  return !wished_ || wished_->position != wish.position || wished_->moves != wish.moves || wished_->extras != wish.extras ||
         !costs_of_change(wished_->settings, wish.settings).empty();
}

void TuneWindow::save(const std::string& path) {
  if (history_ && write_scene(path.empty() ? scene_file() : path) && path.empty()) history_->mark_saved();
}

/// What is saved later goes there, too.
void TuneWindow::save_as(const std::string& path) {
  if (!write_scene(path)) return;
  opened_.overrides.scene_file = path;
  history_->mark_saved();
}

bool TuneWindow::is_idle() const {
  const bool is_still = is_live() || (player_ && shown_ == player_->newest() && !playhead_.is_playing());
  const bool is_shown = !player_ || (!is_new(wanted()) && player_->is_idle() && is_still);
  return is_shown && screenshot_.empty();
}

double TuneWindow::rest_s() {
  constexpr double kProgress_s = 0.1, kLong_s = 1;
  const bool changes = !is_idle() || picture_view_.view == View::flicker || ImGui::GetIO().WantTextInput;
  const double next_s = player_ ? playhead_.until_next_s(player_->status().frame_rate).value_or(kLong_s) : kLong_s;
  return pace_.rest_s(std::min(next_s, changes ? kProgress_s : kLong_s));
}

/// While the footage plays, the next frame is asked for when the last one came: what cannot be drawn in time is left out.
void TuneWindow::ask_player() {
  if (!player_) return;
  const PlayerStatus status = player_->status();
  playhead_.set_frame_count(status.frame_count);
  playhead_.advance(ImGui::GetIO().DeltaTime, status.frame_rate);
  shown_ = player_->newest();
  if (playhead_.is_playing() && !player_->is_idle()) return;
  FrameWish wish = wanted();
  if (!is_new(wish)) return;
  wished_ = wish;
  player_->ask(std::move(wish));
}

void TuneWindow::take_keys() {
  const ImGuiIO& io = ImGui::GetIO();
  if (is_key_pressed("f1")) shows_help_ = !shows_help_;
  if (io.WantTextInput || !history_) return;
  if (io.KeyCtrl && is_key_pressed("z")) io.KeyShift ? history_->redo() : history_->undo();
  if (io.KeyCtrl && is_key_pressed("y")) history_->redo();
  if (io.KeyCtrl && is_key_pressed("s")) save("");
  if (io.KeyCtrl) return;
  if (is_key_pressed("f")) picture_view_.fit();
  if (is_key_pressed("1")) picture_view_.actual_size();
  if (is_key_pressed("w")) hands_.white.toggle();
  if (is_key_pressed("a")) io.KeyShift ? history_->keep(0) : history_->take(0);
  if (is_key_pressed("b")) io.KeyShift ? history_->keep(1) : history_->take(1);
}

bool TuneWindow::button(const char* name, bool is_possible, const char* help) {
  fit_button_on_line(name);
  ImGui::BeginDisabled(!is_possible);
  const bool is_clicked = ImGui::Button(name);
  items_.note(name);
  tooltip(help);
  ImGui::EndDisabled();
  ImGui::SameLine();
  return is_clicked;
}

void TuneWindow::draw_top() {
  const bool is_open = history_.has_value();
  ImGui::SetNextWindowSize({54 * ImGui::GetFontSize(), 0});
  if (begin_menu("open", "open", items_)) {
    const auto chosen = opening_.draw(state_.recordings, items_);
    if (chosen) drop(*chosen);
    if (chosen || is_key_pressed("escape")) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
  }
  if (button("undo", is_open && history_->can_undo(), "ctrl+z")) history_->undo();
  if (button("redo", is_open && history_->can_redo(), "ctrl+y")) history_->redo();
  if (button("save", is_open && !history_->is_saved(), "ctrl+s: writes the scene file, and keeps its comments")) save("");
  if (is_open)
    if (const auto file = save_as_.draw(scene_file(), items_)) save_as(*file);
  if (button("keep A", is_open, "shift+a")) history_->keep(0);
  if (button("A", is_open && history_->has(0), "flip to the settings kept as A")) history_->take(0);
  if (button("keep B", is_open, "shift+b")) history_->keep(1);
  if (button("B", is_open && history_->has(1), "flip to the settings kept as B")) history_->take(1);
  draw_view_choice(picture_view_, shown_.get(), items_);
  if (button("fit", is_open, "the whole picture (f)")) picture_view_.fit();
  if (button("1:1", is_open, "pixel by pixel (1)")) picture_view_.actual_size();
  if (button("?", true, "keys (f1)")) shows_help_ = !shows_help_;
}

void TuneWindow::draw_picture() {
  if (!recording_) {
    if (const auto chosen = opening_.draw_centered(state_.recordings, items_)) drop(*chosen);
    return;
  }
  picture_view_.draw(shown_, items_);
  if (const auto error = player_->status().error) draw_problem(*error);
  if (!shown_) return;
  const std::string problem = hands_.take_input(*shown_, picture_view_, *history_);
  if (!problem.empty()) message_ = problem;
}

void TuneWindow::drop(const std::string& file) {
  try {
    switch (kind_of_dropped(file)) {
      case DroppedKind::probe:
        return set("probe.image", file);
      case DroppedKind::model:
        return set("object.mesh", file);
      case DroppedKind::other:
        throw Error(std::filesystem::path(file).filename().string() +
                    ": not a recording, scene (.toml), video, probe (.exr, .hdr) or model (.glb, .gltf, .obj, .ply)");
      default:
        return leave_for(opened_by_drop(file, opened_.overrides, recording_));
    }
  } catch (const Error& error) {
    message_ = error.what();
  }
}

/// Quits, or opens what is given; where changes would be lost, asks before.
void TuneWindow::leave_for(std::optional<OpenedRecording> next) {
  next_ = std::move(next);
  asks_to_leave_ = history_ && !history_->is_saved();
  if (!asks_to_leave_) leave();
}

void TuneWindow::leave() {
  asks_to_leave_ = false;
  if (!next_) return void(is_done_ = true);
  try {
    open(*std::exchange(next_, std::nullopt));
  } catch (const Error& error) {
    message_ = error.what();
  }
}

void TuneWindow::draw_side() {
  if (history_ && light_panel_.draw(shown_, hands_.white.is_armed(), *history_, items_)) hands_.white.toggle();
  if (history_) controls_.draw(*history_, player_->status(), items_);
  if (!player_) return;
  if (!is_live()) render_panel_.draw(opened_, *history_, playhead_, shown_ ? shown_->number - shown_->position : 0, items_);
  panels_.draw(shown_, player_->status(), playhead_, items_);
}

/// What the player is at, or what it drew last.
void TuneWindow::draw_progress() {
  const PlayerStatus status = player_->status();
  if (!player_->is_idle() && !status.stage.empty())
    return ImGui::ProgressBar(static_cast<float>(std::min(status.share, 1.0)), {200 * surface_.scale(), 0}, status.stage.c_str());
  if (!shown_) return ImGui::TextUnformatted("");
  std::string text = shown_->wish == 0 ? "the footage alone"
                                       : name_of(shown_->rung) + ", " + std::to_string(static_cast<int>(shown_->draw_ms)) + " ms";
  if (shown_->wish != 0 && !shown_->track.found) text += "; no tag in this frame";
  if (!player_->is_idle() && !is_live()) text += "; drawing …";
  ImGui::TextUnformatted(text.c_str());
}

void TuneWindow::draw_status() {
  draw_progress();
  ImGui::SameLine();
  ImGui::TextDisabled("%s", picture_view_.pixel_text().c_str());
  ImGui::SameLine();
  ImGui::TextUnformatted(message().c_str());
  tooltip(message());
}

void TuneWindow::draw_bottom() {
  if (!player_) return ImGui::TextWrapped("%s", message_.c_str());
  if (is_live()) {
    const std::string problem = live_panel_.draw(*player_->live(), recording_->footage, *history_, playhead_, items_);
    if (!problem.empty()) message_ = problem;
  } else
    draw_transport(playhead_, shown_ ? shown_->number : 0, shown_ ? shown_->time_s : 0, items_);
  draw_status();
}

void TuneWindow::draw_questions() {
  if (shows_help_ && ImGui::Begin("Keys", &shows_help_, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings))
    for (const auto& [key, does] : kHelp) {
      ImGui::TextUnformatted(key);
      ImGui::SameLine(ImGui::GetFontSize() * 10);
      ImGui::TextUnformatted(does);
    }
  if (shows_help_) ImGui::End();
  if (!asks_to_leave_) return;
  ImGui::OpenPopup("Unsaved changes");
  if (!ImGui::BeginPopupModal("Unsaved changes", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return;
  ImGui::Text("%s has changes that are not saved.", recording_->name.c_str());
  const auto choice = [&](const std::string& name) {
    const bool is_clicked = ImGui::Button(name.c_str());
    items_.note(name);
    ImGui::SameLine();
    return is_clicked;
  };
  const std::string leaves = next_ ? "open" : "quit";
  if (choice("save and " + leaves)) save(""), history_->is_saved() ? leave() : void(asks_to_leave_ = false);
  if (choice(leaves + " without saving")) leave();
  if (choice("stay")) asks_to_leave_ = false;
  if (!asks_to_leave_) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

std::string TuneWindow::message() const {
  return message_.empty() && player_ ? player_->status().damage.value_or("") : message_;
}

void TuneWindow::take_screenshot() {
  if (screenshot_.empty()) return;
  write_picture(std::exchange(screenshot_, ""), surface_.picture());
}

void TuneWindow::frame() {
  surface_.begin_frame();
  items_.begin_frame();
  for (const std::string& file : surface_.take_dropped_files()) drop(file);
  take_keys();
  ask_player();
  const bool has_side = recording_.has_value();
  layout_.begin_frame(surface_.scale(), has_side);
  layout_.begin_top();
  draw_top();
  layout_.end_top();
  layout_.begin_picture();
  draw_picture();
  layout_.end();
  if (has_side) {
    layout_.draw_edge(items_);
    layout_.begin_side();
    draw_side();
    layout_.end();
  }
  layout_.begin_bottom();
  draw_bottom();
  layout_.end_bottom();
  draw_questions();
  surface_.end_frame();
  if (shown_) live_panel_.note_shown(*shown_);
  take_screenshot();
  if (!surface_.is_closed()) return;
  surface_.keep_open();
  leave_for(std::nullopt);
}

}  // namespace catchlight::app
