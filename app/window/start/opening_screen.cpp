#include "app/window/start/opening_screen.hpp"

#include <imgui.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace catchlight::app {
namespace {

namespace fs = std::filesystem;

/// "# A mirror ball at sunset." says what the scene is.
std::string first_comment(const fs::path& file) {
  std::string line;
  std::getline(std::ifstream(file) >> std::ws, line);
  return line.starts_with("# ") ? line.substr(2) : "";
}

std::vector<Example> examples_in(const fs::path& folder) {
  std::vector<Example> examples;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing)) {
    const fs::path scene = entry.path() / "scene.toml";
    if (fs::exists(scene, missing))
      examples.push_back({entry.path().filename().string(), entry.path().string(), first_comment(scene)});
  }
  std::ranges::sort(examples, {}, &Example::name);
  return examples;
}

bool button(const std::string& text, const std::string& name, float width, GuiItems& items) {
  const bool is_clicked = ImGui::Button((text + "###" + name).c_str(), {width, 0});
  items.note(name);
  return is_clicked;
}

float drawn_width() {
  return std::min(ImGui::GetContentRegionAvail().x, 52 * ImGui::GetFontSize());
}

void heading(const char* text) {
  ImGui::Dummy({0, 0.7f * ImGui::GetFontSize()});
  ImGui::TextDisabled("%s", text);
}

}  // namespace

std::vector<Example> shipped_recordings() {
  std::error_code missing;
  for (fs::path folder = fs::read_symlink("/proc/self/exe", missing); folder.has_relative_path();) {
    folder = folder.parent_path();
    for (const fs::path& place : {folder / "share/catchlight/recordings", folder / "recordings"})
      if (std::vector<Example> found = examples_in(place); !found.empty()) return found;
  }
  return {};
}

std::optional<std::string> OpeningScreen::draw(const std::vector<std::string>& last, GuiItems& items) {
  if (!examples_) examples_ = shipped_recordings();
  std::optional<std::string> chosen;
  const float width = drawn_width();
  ImGui::PushStyleVar(ImGuiStyleVar_ButtonTextAlign, {0, 0.5f});
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width);
  ImGui::TextUnformatted("Drop a recording on this window: a folder with footage, camera.yaml and scene.toml.");
  ImGui::TextUnformatted("Then drop a light probe (.exr, .hdr) or a model (.glb, .gltf, .obj, .ply) to use it.");
  if (!last.empty()) heading("LAST OPENED");
  int number = 0;
  std::error_code missing;
  for (const std::string& folder : last) {
    const std::string name = "recent " + std::to_string(++number);
    if (fs::is_directory(folder, missing) && button(folder, name, width, items)) chosen = folder;
  }
  if (!examples_->empty()) heading("EXAMPLES");
  for (const Example& example : *examples_) {
    if (button(example.name, "example " + example.name, 7 * ImGui::GetFontSize(), items)) chosen = example.folder;
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(example.about.c_str());
  }
  ImGui::PopTextWrapPos();
  ImGui::PopStyleVar();
  return chosen;
}

std::optional<std::string> OpeningScreen::draw_centered(const std::vector<std::string>& last, GuiItems& items) {
  const ImVec2 room = ImGui::GetContentRegionAvail();
  ImGui::SetCursorPos({ImGui::GetCursorPosX() + 0.5f * (room.x - drawn_width()), ImGui::GetCursorPosY() + 0.15f * room.y});
  ImGui::BeginGroup();
  const std::optional<std::string> chosen = draw(last, items);
  ImGui::EndGroup();
  return chosen;
}

}  // namespace catchlight::app
