// Makes codes of the composite's linear light: metering, tone curve, the footage's response, over the whole frame.
#pragma once

#include <memory>

#include "catchlight/plate.hpp"
#include "catchlight/tone_curve.hpp"
#include "catchlight/util/raw_vector.hpp"
#include "render/gl/fullscreen.hpp"
#include "render/gl/render_target.hpp"
#include "render/gl/shader_library.hpp"
#include "render/passes/glare/classic_glare.hpp"
#include "render/settings.hpp"
#include "render/tone/tone_curve.hpp"

namespace catchlight::render {

/// Counts luminances on the GPU. Whole numbers are added, so that the result is the same to the bit whatever the order.
class ToneMeter {
 public:
  explicit ToneMeter(ShaderLibrary& shaders);

  /// Measures the first width x height texels of `light`. A pixel with a NaN counts for nothing, an infinite one as 2^32. Waits
  /// for the GPU.
  LuminanceHistogram measure(const GlTexture& light, int width, int height, const glm::dvec3& luminance_weights);

 private:
  Program& program_;
  FullscreenDraw draw_;
  GlBuffer bins_;
  GlFramebuffer nothing_;  ///< no attachments: the shader only counts
};

class TonePass {
 public:
  TonePass(const CompositorSettings& settings, ShaderLibrary& shaders);

  /// The curve that the composite (linear light, frame in its first texels) calls for.
  ToneCurve meter(const GlTexture& light, int width, int height, const PlateColor& color);

  /// Draws bloom and streaks of the classic look, where it is chosen.
  void draw_glare(const GlTexture& light, int width, int height);

  /// Draws codes by the response of the CompositeUniforms that are bound.
  void draw(const GlTexture& light, int width, int height, const PlateColor& color, const ToneCurve& curve);

  /// The last draw's codes, RGBA; alpha is 1.
  RawVector<float> read() const;

 private:
  ToneSettings settings_;
  GlareSettings glare_;
  ToneMeter meter_;
  std::unique_ptr<ClassicLook> classic_;  ///< null: another look, or no glare
  Program& program_;
  FullscreenDraw draw_;
  GlTexture black_;
  std::unique_ptr<ColorTarget<1>> output_;
  int width_ = 0, height_ = 0;
};

}  // namespace catchlight::render
