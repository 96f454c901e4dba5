// Streaks: the excess smeared along several directions, falling off exponentially (Kawase, GDC 2003).
#pragma once

#include <string>

#include "render/glare_plan.hpp"
#include "render/glare_target.hpp"
#include "render/tap_programs.hpp"

namespace catchlight::render {

class StreakPass {
 public:
  explicit StreakPass(const std::string& shader_folder);

  void resize(int columns, int rows);

  /// Before the first streak of a frame; all of them are drawn over the same texels.
  void begin() const;

  /// Adds the sum over `taps` of weight x source(texel - offset), pass after pass, to `target` over `texels`.
  void add(const GlTexture& source, const std::vector<StreakPassTaps>& passes, const ColorTarget<1>& target,
           const PixelRect& texels) const;

 private:
  TapPrograms programs_;
  std::vector<ColorTarget<1>> between_;  ///< what one pass leaves to the next
};

}  // namespace catchlight::render
