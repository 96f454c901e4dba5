// The picture in the middle of the window.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <string>

#include "app/window/picture/overlays.hpp"
#include "app/window/playing/shot_player.hpp"
#include "app/window/surface/gui_items.hpp"
#include "render/gl/gl_objects.hpp"

namespace catchlight::app {

class PictureView {
 public:
  View view = View::composite;
  float gain = 8;  ///< of the difference
  int light = 0;   ///< of View::light: 0 is the environment
  PictureOverlays overlays;
  bool against_truth = false;  ///< the composite is held against the truth instead of the plate, where there is one

  /// Draws the frame into the current ImGui window, as large as fits or as it is zoomed: the wheel zooms, the middle button
  /// moves.
  void draw(const std::shared_ptr<const DrawnFrame>& frame, GuiItems& items);

  /// What has to be drawn of a frame beside its composite, for this view.
  FrameExtras wanted() const;

  /// The whole picture in the window.
  void fit() { zoom_ = 0; }
  /// A pixel of the picture is a pixel of the screen.
  void actual_size() { zoom_ = 1; }

  /// What the pixel under the pointer holds; empty where there is none.
  const std::string& pixel_text() const { return pixel_text_; }
  /// The place of the picture under the pointer, beside it too.
  const glm::dvec2& pointed_px() const { return pointed_px_; }
  /// Whether the pointer is free to take hold of what is seen: over the picture, with no edge of the split to drag.
  bool may_take_hold() const { return !pixel_text_.empty() && view != View::split; }

 private:
  bool shows_layer(const DrawnFrame& frame) const;
  PicturePlace place(const DrawnFrame& frame) const;
  void take_input(const PicturePlace& place, const glm::vec2& size_px);
  void upload(const DrawnFrame& frame);
  void draw_split(const PicturePlace& place, const glm::vec2& size_px);
  void look_under_pointer(const DrawnFrame& frame, const PicturePlace& place);

  std::shared_ptr<const DrawnFrame> shown_;
  View uploaded_view_ = View::composite;
  float uploaded_gain_ = 0;
  bool uploaded_truth_ = false;
  int width_ = 0, height_ = 0;
  render::GlTexture first_, second_;  ///< the view's picture, and what it is beside or flickers with
  float zoom_ = 0;                    ///< pixels of the screen a pixel of the picture; 0: as large as fits
  glm::vec2 moved_px_{0};
  float split_ = 0.5f;
  std::string pixel_text_;
  glm::dvec2 pointed_px_{0};
};

}  // namespace catchlight::app
