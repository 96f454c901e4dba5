// The picture that ImGui draws into before it is shown.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "app/window/surface/rgb_picture.hpp"
#include "render/gl/render_target.hpp"

namespace catchlight::app {

class GuiPicture {
 public:
  /// Draws what ImGui was asked for, `size_px` large. Needs ImGui's OpenGL backend.
  void draw(const glm::ivec2& size_px);
  /// Copies it to the window's own framebuffer.
  void show() const;
  RgbPicture read() const;

 private:
  std::optional<render::ColorTarget<1>> target_;
};

}  // namespace catchlight::app
