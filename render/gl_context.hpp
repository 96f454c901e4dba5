// A current OpenGL 4.5 core context without a window.
#pragma once

#include <memory>
#include <string>

namespace catchlight::render {

/// Current on the creating thread while it lives.
class GlContext {
 public:
  virtual ~GlContext() = default;
};

struct GlInfo {
  std::string vendor, renderer, version, glsl_version, platform;
};

/// EGL: first device platform, then Mesa's surfaceless, then the default display. Throws Error with what each of them said.
/// Installs a debug callback that turns high-severity messages into an Error at the next check_gl().
std::unique_ptr<GlContext> make_headless_context();

/// Of the current context.
GlInfo gl_info();

}  // namespace catchlight::render
