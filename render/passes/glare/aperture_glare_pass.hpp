// Glare by convolution in place of the fast passes: read back, convolved on the CPU, uploaded.
#pragma once

#include <optional>

#include "catchlight/camera.hpp"
#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "render/gl/gl_objects.hpp"
#include "render/glare/fft_glare.hpp"

namespace catchlight::render {

class ApertureGlarePass {
 public:
  /// Throws Error as FftGlare does.
  explicit ApertureGlarePass(const GlareSettings& settings);

  /// Extracts what of `object` (which holds the frame's pixels of `rect`) glares. False where nothing does: there is no glare.
  bool extract(const GlTexture& object, const PixelRect& rect, int frame_width, int frame_height);

  /// Convolves the excess; only after extract() was true. Gives the pixels of the frame that the glare reaches.
  PixelRect spread(const CameraModel& camera);

  /// The glare that is added to the frame, exposed linear light, by pixels of the frame.
  const GlTexture& glare() const { return texture_; }

 private:
  GlareSettings settings_;
  FftGlare glare_;
  std::optional<Image> excess_;
  GlTexture texture_;
  int width_ = 0, height_ = 0;
};

}  // namespace catchlight::render
