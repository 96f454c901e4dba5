// A separable blur on the glare grid.
#pragma once

#include <vector>

#include "catchlight/pixel_rect.hpp"
#include "render/gl/fullscreen.hpp"
#include "render/gl/shader_library.hpp"
#include "render/passes/glare/glare_target.hpp"

namespace catchlight::render {

class GlareBlur {
 public:
  explicit GlareBlur(ShaderLibrary& shaders) : shaders_(shaders) {}

  /// One axis of a blur, ready to be drawn: along the rows (0) or down the columns (1) of `source`. Both together have `weight`.
  const Program& axis(const GlTexture& source, int axis, const std::vector<double>& taps, double weight);

  /// Adds `weight` times the blurred `source` to `target` over `texels`; both and `scratch` are of one size. `taps` are the
  /// weights at distance 0, 1, 2 ...
  void add(const GlTexture& source, const ColorTarget<1>& scratch, const ColorTarget<1>& target, const std::vector<double>& taps,
           double weight, const PixelRect& texels);

 private:
  ShaderLibrary& shaders_;
  FullscreenDraw draw_;
};

}  // namespace catchlight::render
