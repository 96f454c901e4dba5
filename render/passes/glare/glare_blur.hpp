// A separable blur on the glare grid.
#pragma once

#include <string>
#include <vector>

#include "catchlight/pixel_rect.hpp"
#include "render/gl/tap_programs.hpp"
#include "render/passes/glare/glare_target.hpp"

namespace catchlight::render {

class GlareBlur {
 public:
  explicit GlareBlur(const std::string& shader_folder);

  /// Makes one axis of a blur the current program: along the rows (0) or down the columns (1) of `source`. Both together have
  /// `weight`.
  void use(const GlTexture& source, int axis, const std::vector<double>& taps, double weight) const;

  /// Adds `weight` times the blurred `source` to `target` over `texels`; both and `scratch` are of one size. `taps` at distance
  /// 0, 1, 2 ...
  void add(const GlTexture& source, const ColorTarget<1>& scratch, const ColorTarget<1>& target, const std::vector<double>& taps,
           double weight, const PixelRect& texels) const;

 private:
  TapPrograms programs_;
};

}  // namespace catchlight::render
