// What is drawn over the picture: what the tracker found, and what the object covers.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <set>

#include "app/window/picture/picture_place.hpp"
#include "app/window/playing/shot_player.hpp"
#include "app/window/surface/gui_items.hpp"
#include "render/gl/gl_objects.hpp"

namespace catchlight::app {

enum class Overlay { tag, axes, residual, state, object, shadow, receiver };
constexpr auto names_of(Overlay) {
  return std::array{"tag", "axes", "residual", "state", "object", "shadow", "receiver"};
}

class PictureOverlays {
 public:
  std::set<Overlay> on;
  float residual_gain = 50;

  /// Draws those that are on over the picture in the current ImGui window.
  void draw(const std::shared_ptr<const DrawnFrame>& frame, const PicturePlace& place);

  /// The menu `overlays`, whose entries are `overlay NAME`.
  void draw_choice(GuiItems& items);

  /// Adds what has to be drawn of a frame for them.
  void add_wanted(FrameExtras& extras) const;

 private:
  void draw_masks(const std::shared_ptr<const DrawnFrame>& frame, const PicturePlace& place);
  bool is_on(Overlay overlay) const { return on.contains(overlay); }

  render::GlTexture masks_;
  glm::ivec2 masks_size_{0};
  std::shared_ptr<const DrawnFrame> tinted_;
  std::set<Overlay> tinted_on_;
};

}  // namespace catchlight::app
