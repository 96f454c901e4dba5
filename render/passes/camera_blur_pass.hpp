// Draws the blur of the virtual layer: of the object, premultiplied, and of the shadow's ratio.
#pragma once

#include <memory>

#include "catchlight/pixel_rect.hpp"
#include "render/camera/camera_blur.hpp"
#include "render/gl/fullscreen.hpp"
#include "render/gl/render_target.hpp"
#include "render/gl/shader_library.hpp"

namespace catchlight::render {

class CameraBlur {
 public:
  explicit CameraBlur(ShaderLibrary& shaders);

  /// Blurs textures that hold the frame's pixels of `rect`. Beyond it, its outermost pixels go on.
  void apply(const CameraBlurPlan& plan, const GlTexture& object, const GlTexture& shadow, const PixelRect& rect);

  const GlTexture& object() const { return targets_[latest_]->texture(0); }
  const GlTexture& shadow() const { return targets_[latest_]->texture(1); }

 private:
  Program &gaussian_, &motion_;
  FullscreenDraw draw_;
  std::unique_ptr<ColorTarget<2>> targets_[2];  ///< drawn to in turn
  int latest_ = 0;
};

}  // namespace catchlight::render
