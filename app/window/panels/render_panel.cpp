#include "app/window/panels/render_panel.hpp"

#include <imgui.h>

#include <imgui_stdlib.h>

#include <vector>

#include "app/window/editing/overlay_command.hpp"

namespace catchlight::app {

void RenderPanel::draw(const OpenedRecording& opened, const SettingsHistory& history, const Playhead& playhead,
                       std::int64_t first_number, GuiItems& items) {
  if (!items.section("render")) return;
  ImGui::SetNextItemWidth(-1);
  ImGui::InputText("##output", &output_);
  items.note("output");
  const FrameRange all{}, marked{first_number + playhead.begin(), first_number + playhead.end()};
  const bool is_all = playhead.begin() == 0 && playhead.end() == playhead.frame_count();
  const std::vector<std::string> arguments =
      overlay_arguments(opened.location, opened.overrides, history.file(), history.now(), is_all ? all : marked, output_);
  const std::string command = "catchlight " + shell_text(arguments);
  ImGui::TextWrapped("%s", command.c_str());
  if (ImGui::Button("copy the command")) ImGui::SetClipboardText(command.c_str());
  items.note("copy the command");
  ImGui::SameLine();
  ImGui::BeginDisabled(run_ && !run_->is_over());
  if (ImGui::Button("draw the file")) run_ = std::make_unique<BackgroundRun>(arguments);
  items.note("draw the file");
  ImGui::EndDisabled();
  if (run_) ImGui::TextWrapped("%s", run_->has_succeeded() ? ("made " + output_).c_str() : run_->last_line().c_str());
}

}  // namespace catchlight::app
