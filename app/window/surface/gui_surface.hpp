// What the window is drawn on: a window of the desktop, or a picture in memory. Both give Dear ImGui its input.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/window/surface/rgb_picture.hpp"

namespace catchlight::app {

/// A surface with a current OpenGL context and an ImGui context of its own; one lives at a time.
class GuiSurface {
 public:
  virtual ~GuiSurface() = default;

  /// Begins a frame of the window: what ImGui is asked to draw from here on is part of it.
  virtual void begin_frame() = 0;
  /// Draws it and shows it.
  virtual void end_frame() = 0;

  /// Sleeps until there is input or somebody calls `wake`, and no longer than this.
  virtual void rest(double seconds) = 0;
  /// Ends a rest, the next one if there is none now. From any thread.
  virtual void wake() = 0;

  /// Whether the user closed the window. `keep_open` takes that back.
  virtual bool is_closed() const = 0;
  virtual void keep_open() = 0;

  /// Files that were dropped on the window since the last call.
  virtual std::vector<std::string> take_dropped_files() = 0;

  virtual void set_title(const std::string& title) = 0;

  /// How many pixels of the screen a unit of length is that the layout is made in.
  virtual float scale() const = 0;

  /// What the last frame showed.
  virtual RgbPicture picture() const = 0;
};

/// A picture in memory, `size` units large, on the context that EGL gives without a screen. Time goes on by a sixtieth of a
/// second a frame, and input is what is written into ImGui's IO. Throws Error where there is no OpenGL.
std::unique_ptr<GuiSurface> make_headless_surface(const glm::ivec2& size, double scale = 1);

/// A window. `scale`: instead of the display's. `is_driven`: a script moves the pointer, and not the hand that may be there too.
/// Throws Error that says what is missing where there is no screen.
std::unique_ptr<GuiSurface> make_window_surface(const glm::ivec2& size, const std::string& title, std::optional<double> scale,
                                                bool is_driven);

}  // namespace catchlight::app
