// Where the window's parts are, and what keeps their contents within them.
#pragma once

#include <imgui.h>

#include <string>

#include "app/window/surface/gui_items.hpp"

namespace catchlight::app {

/// Bars above and below, as high as what they hold; between them the picture, and a panel at its side, whose edge can be dragged.
/// Each part is an ImGui window without a frame: begin one, draw into it, end it.
class WindowLayout {
 public:
  static constexpr float kSideWidth = 370;

  /// Takes the window's size from ImGui. `scale`: pixels a unit. Without a side panel the picture has its place too.
  void begin_frame(float scale, bool has_side);

  void begin_top();
  void end_top();
  void begin_bottom();
  void end_bottom();
  void begin_picture();
  void begin_side();
  void end() { ImGui::End(); }

  /// The edge of the side panel. Named "side-edge".
  void draw_edge(GuiItems& items);

  float side_width = kSideWidth;  ///< in units

 private:
  struct Part {
    float x, y, width, height;
  };
  static void begin(const char* name, const Part& part, ImGuiWindowFlags flags = 0);
  float side_px() const;
  float main_px() const { return size_.x - side_px() - edge_px(); }
  float edge_px() const;

  ImVec2 size_{};
  float scale_ = 1;
  bool has_side_ = true;
  float top_px_ = 0, bottom_px_ = 0;  ///< what they held in the last frame
};

/// Before an item of that width: begins a new line where it would not fit into this one.
void fit_on_line(float width_px);
/// The same for a button of that text; a radio button or a checkbox has a box beside it.
void fit_button_on_line(const std::string& text);
void fit_box_on_line(const std::string& text);

/// Tells of the item that was drawn last while the pointer is over it, in lines that are not too long to read.
void tooltip(const std::string& text);

}  // namespace catchlight::app
