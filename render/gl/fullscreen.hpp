// Drawing over texels: what every pass does that computes a target's texels from other textures.
#pragma once

#include <string>
#include <vector>

#include "catchlight/pixel_rect.hpp"
#include "render/gl/program.hpp"
#include "render/gl/render_target.hpp"

namespace catchlight::render {

/// A fragment shader that is run for texels, in all of which it is alike but for gl_FragCoord.
ProgramSource fullscreen(std::string fragment, std::vector<std::string> defines = {});

/// The same with a loop of `count` steps (TAPS). With the number known when it is compiled the loop unrolls and weights have
/// fixed places; a loop of unknown length over a uniform array costs a software rasteriser several times as much, and all of the
/// array.
ProgramSource fullscreen_with_taps(std::string fragment, int count, std::vector<std::string> defines = {});

enum class Blending { replace, add };

/// Draws fullscreen() programs. It sets all the GL state that it needs but textures and buffers.
class FullscreenDraw {
 public:
  FullscreenDraw();

  /// Draws over these texels of the framebuffer.
  void over(const PixelRect& texels, GLuint framebuffer, const Program& program, Blending blending = Blending::replace) const;

  /// Draws over many rectangles at once; texels that are in several are drawn several times.
  void over(const std::vector<PixelRect>& rectangles, const ColorTarget<1>& target, const Program& program,
            Blending blending = Blending::replace) const;

 private:
  GlBuffer corners_;  ///< corners of the rectangles that are drawn
  GlVertexArray vertex_array_;
};

}  // namespace catchlight::render
