// Where the frame's pixels are on the screen.
#pragma once

#include <glm/glm.hpp>

namespace catchlight::app {

struct PicturePlace {
  glm::vec2 corner_px;  ///< of the picture, on the screen
  float zoom;

  /// On the screen, of a place in pixels of the frame, in which (0, 0) is the middle of the first.
  glm::vec2 screen_px(const glm::dvec2& frame_px) const { return corner_px + zoom * (glm::vec2(frame_px) + 0.5f); }
};

}  // namespace catchlight::app
