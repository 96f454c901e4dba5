// A separable blur on the glare grid.
#pragma once

#include <span>
#include <string>

#include "render/glare_target.hpp"
#include "render/tap_programs.hpp"

namespace catchlight::render {

class GlareBlur {
 public:
  explicit GlareBlur(const std::string& shader_folder);

  /// Adds the blurred `source` to `target` over `texels`; both and `scratch` are of one size. `taps` at distance 0, 1, 2 ...
  void add(const GlTexture& source, const ColorTarget<1>& scratch, const ColorTarget<1>& target, std::span<const float> taps,
           const PixelRect& texels) const;

 private:
  TapPrograms programs_;
};

}  // namespace catchlight::render
