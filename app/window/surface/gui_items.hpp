// Where the window's controls are, by name: scripts click them.
#pragma once

#include <imgui.h>

#include <map>
#include <optional>
#include <string>

namespace catchlight::app {

class GuiItems {
 public:
  struct Rect {
    ImVec2 min, max;
  };

  /// The controls of the last frame go.
  void begin_frame() { rects_.clear(); }
  /// Notes the control that was drawn last.
  void note(const std::string& name) { rects_[name] = {ImGui::GetItemRectMin(), ImGui::GetItemRectMax()}; }
  std::optional<Rect> find(const std::string& name) const {
    const auto found = rects_.find(name);
    return found == rects_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  std::map<std::string, Rect> rects_;
};

}  // namespace catchlight::app
