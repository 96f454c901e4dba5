#include "app/window/panels/save_as.hpp"

#include <imgui.h>

#include <imgui_stdlib.h>

#include <filesystem>

#include "app/window/surface/gui_menu.hpp"

namespace catchlight::app {

std::optional<std::string> SaveAs::draw(const std::string& scene_file, GuiItems& items) {
  const std::filesystem::path now(scene_file);
  std::optional<std::string> chosen;
  if (!begin_menu("save as", "save as", items)) return chosen;
  if (ImGui::IsWindowAppearing()) name_ = now.stem().string() + "-2.toml";
  ImGui::TextDisabled("beside %s", now.filename().c_str());
  ImGui::InputText("##file name", &name_);
  items.note("file name");
  const bool is_name = !name_.empty() && std::filesystem::path(name_).filename() == name_;
  const std::filesystem::path file = now.parent_path() / name_;
  std::error_code unknown;
  const bool is_there = is_name && std::filesystem::exists(file, unknown);
  ImGui::BeginDisabled(!is_name);
  if (ImGui::Button(is_there ? "replace" : "write")) chosen = file.string();
  items.note(is_there ? "replace" : "write");
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::TextUnformatted(!is_name ? "a name without a folder" : is_there ? "is there already" : "");
  if (chosen) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
  return chosen;
}

}  // namespace catchlight::app
