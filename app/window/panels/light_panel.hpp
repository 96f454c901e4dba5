// The probe as a mirror ball on the tag shows it, with the lights that throw shadows.
#pragma once

#include <glm/glm.hpp>
#include <memory>

#include "app/window/editing/settings_history.hpp"
#include "app/window/playing/shot_player.hpp"
#include "app/window/surface/gui_items.hpp"
#include "render/gl/gl_objects.hpp"

namespace catchlight::app {

class LightPanel {
 public:
  /// Draws the section into the current ImGui window. A drag across the ball turns the probe. Whether the eyedropper for the
  /// white balance was asked for; `picks_white`: it is out already.
  bool draw(const std::shared_ptr<const DrawnFrame>& frame, bool picks_white, SettingsHistory& history, GuiItems& items);

 private:
  void renew(const FrameLight& light, const glm::dmat3& probe_from_ball, int size_px);
  void draw_ball(const DrawnFrame& frame, SettingsHistory& history, GuiItems& items);

  std::shared_ptr<const SmallProbe> drawn_;  ///< that the ball shows, turned and exposed in this way
  glm::dmat3 drawn_probe_from_ball_{0.0};
  glm::dvec3 drawn_exposure_{0.0};
  int size_px_ = 0;
  render::GlTexture ball_;
};

}  // namespace catchlight::app
