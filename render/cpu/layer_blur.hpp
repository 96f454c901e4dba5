// Defocus and motion blur of the virtual layer on the processor, as the lens and the shutter blur the light.
#pragma once

#include <vector>

#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "render/camera/camera_blur.hpp"
#include "render/cpu/float4.hpp"

namespace catchlight::render {

class LayerBlur {
 public:
  /// A Gaussian of `variance_px2`, in place, of four-channel pixels; `active` holds all that differ from their surroundings. At
  /// the image's borders the outermost pixels go on.
  void defocus(Image& image, const PixelRect& active, double variance_px2);

  /// A box along each pixel's own motion. `corner_px`: the pixel of the frame that the image's first is.
  void move(Image& image, const PixelRect& active, const MotionField& motion, const glm::dvec2& corner_px);

 private:
  std::vector<Float4> scratch_;
};

}  // namespace catchlight::render
