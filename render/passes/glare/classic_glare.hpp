// The glare of the first real-time HDR pictures (Kawase, "Frame Buffer Postprocessing Effects in DOUBLE-S.T.E.A.L", GDC 2003, and
// the sample programs after it): bloom at fixed small sizes and a four-pointed star, of everything bright in the picture.
// docs/auto-exposure.md lists where it departs from that chain.
#pragma once

#include "render/gl/fullscreen.hpp"
#include "render/gl/render_target.hpp"
#include "render/gl/shader_library.hpp"

namespace catchlight::render {

class ClassicLook {
 public:
  explicit ClassicLook(ShaderLibrary& shaders);

  /// Draws the glare of the picture in the first width x height texels of `light` (linear): of luminance over `threshold`, which
  /// keeps its colour.
  void draw(const GlTexture& light, int width, int height, double threshold, double attenuation);

  /// The sum of three Gaussians, each of unit sum, of the bright parts at 512, 256 and 64 squared over the whole picture.
  const GlTexture& bloom() const { return bloom_.texture(); }
  /// The mean of four diagonal streaks, at 128 squared: a^k at k texels from a bright one, along the picture's diagonals.
  const GlTexture& streaks() const { return streaks_.texture(); }
  /// The bright parts that both are made of, 512 squared: means over each texel of the picture.
  const GlTexture& bright() const { return bright_.texture(); }

 private:
  void draw_over(const ColorTarget<1>& target, const GlTexture& source, const Program& program,
                 Blending blending = Blending::replace) const;
  void blur(const ColorTarget<1>& source, const ColorTarget<1>& half_done, const ColorTarget<1>& target);
  void draw_streaks(const GlTexture& source, double attenuation);

  Program &bright_program_, &shrink_, &blur_, &sum_, &streak_;
  FullscreenDraw draw_;
  ColorTarget<1> bright_, bright_256_, bright_128_, bright_64_;
  ColorTarget<1> half_done_512_, half_done_256_, half_done_64_, blurred_512_, blurred_256_, blurred_64_, bloom_;
  ColorTarget<1> streak_pass_[2], streaks_;
};

}  // namespace catchlight::render
