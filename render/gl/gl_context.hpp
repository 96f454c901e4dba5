// A current OpenGL 4.5 core context without a window.
#pragma once

#include <memory>
#include <string>

namespace catchlight::render {

/// A context is current on the creating thread until another is made or made current there. All made in it must go before it
/// goes.
class GlContext {
 public:
  virtual ~GlContext() = default;

  /// Makes the context the calling thread's; cheap where it already is. Throws Error where another thread has it.
  virtual void make_current() = 0;
};

struct GlInfo {
  std::string vendor, renderer, version, glsl_version, platform;
};

/// A context by EGL: of the first device platform, else Mesa's surfaceless, else the default display. Throws Error with what each
/// said. Installs a debug callback that turns high-severity messages into an Error at the next check_gl().
std::unique_ptr<GlContext> make_headless_context();

/// A context like that on a graphics card; null where there is no card that OpenGL 4.5 works on, or only a software rasteriser.
std::unique_ptr<GlContext> make_hardware_context();

/// What the current context says about itself.
GlInfo gl_info();

/// Makes high-severity messages of the current context wait for check_gl(). Headless contexts have it from the start.
void install_debug_callback();

/// Throws Error if GL complained since the last call; `where` names what was being done.
void check_gl(const std::string& where);

}  // namespace catchlight::render
