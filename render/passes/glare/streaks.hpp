// Streaks: the excess smeared along several directions, falling off exponentially (Kawase, GDC 2003).
#pragma once

#include <span>
#include <vector>

#include "catchlight/pixel_rect.hpp"
#include "render/gl/fullscreen.hpp"
#include "render/gl/shader_library.hpp"
#include "render/glare/glare_plan.hpp"
#include "render/passes/glare/glare_target.hpp"

namespace catchlight::render {

class StreakPass {
 public:
  explicit StreakPass(ShaderLibrary& shaders) : shaders_(shaders) {}

  /// Adds to `target`, over `texels`, the sum over `arms` of what their passes, one after the other, make of `source`. All arms
  /// have as many passes. The source, of the target's size, is black outside of `light`.
  void add(const GlTexture& source, const PixelRect& light, std::span<const std::vector<StreakSamples>> arms,
           const ColorTarget<1>& target, const PixelRect& texels);

 private:
  void add_some(const GlTexture& source, const PixelRect& light, std::span<const std::vector<StreakSamples>> arms,
                const ColorTarget<1>& target, const PixelRect& texels);
  /// One pass of one arm, ready to be drawn. `down`: how far below the target's texels the source's lie; `bounds`: texels of
  /// the source outside of which it counts as black.
  const Program& pass(const GlTexture& source, const StreakSamples& samples, int down, const PixelRect& bounds);

  ShaderLibrary& shaders_;
  FullscreenDraw draw_;
  /// The results that one pass leaves to the next: a band for each arm, one below the other, so that a pass draws them without a
  /// pause.
  std::vector<ColorTarget<1>> between_;
};

}  // namespace catchlight::render
