// Draws the blur of a texture of the virtual layer.
#pragma once

#include <memory>

#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "render/camera/camera_blur.hpp"
#include "render/gl/fullscreen.hpp"
#include "render/gl/render_target.hpp"
#include "render/gl/shader_library.hpp"

namespace catchlight::render {

class CameraBlur {
 public:
  explicit CameraBlur(ShaderLibrary& shaders);

  /// Blurs a texture that holds the frame's pixels of `rect`, by the plan's defocus and by `motion` where the plan moves. Beyond
  /// the rectangle, its outermost pixels go on. The result stays until the next call.
  const GlTexture& apply(const CameraBlurPlan& plan, const MotionField& motion, const GlTexture& sharp, const PixelRect& rect);

  /// The first width x height pixels of the last result, RGBA.
  Image read(int width, int height) const;

 private:
  Program &gaussian_, &motion_;
  FullscreenDraw draw_;
  std::unique_ptr<ColorTarget<1>> targets_[2];  ///< drawn to in turn
  int latest_ = 0;
};

}  // namespace catchlight::render
