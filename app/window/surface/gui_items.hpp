// What all parts of the window share: where its controls are, by name, for scripts to click them, and which sections are open.
#pragma once

#include <imgui.h>

#include <map>
#include <optional>
#include <set>
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
  /// A heading under which there is more, where it is open: a control of its own. `shows_all`: it is open whatever was clicked.
  bool section(const char* name, bool shows_all = false);
  std::optional<Rect> find(const std::string& name) const {
    const auto found = rects_.find(name);
    return found == rects_.end() ? std::nullopt : std::optional(found->second);
  }

  std::set<std::string> open_sections;  ///< what the window remembers

 private:
  std::map<std::string, Rect> rects_;
};

}  // namespace catchlight::app
