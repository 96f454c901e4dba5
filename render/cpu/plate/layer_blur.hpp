// Defocus and motion blur of the virtual layer on the processor, as the lens and the shutter blur the light.
#pragma once

#include <span>
#include <vector>

#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "render/camera/camera_blur.hpp"

namespace catchlight::render {

class LayerBlur {
 public:
  /// Convolves four-channel pixels in place with `weights` (of the middle and of each side, as discrete_gaussian() has them) both
  /// ways; `active` (bands below each other, as they lie) holds all pixels that differ from their surroundings. At the image's
  /// borders the outermost pixels go on.
  void defocus(Image& image, std::span<const PixelRect> active, const std::vector<float>& weights);

  /// A box along each pixel's own motion. `corner_px`: the pixel of the frame that the image's first is.
  void move(Image& image, const PixelRect& active, const MotionField& motion, const glm::dvec2& corner_px);

 private:
  std::vector<float> scratch_;
};

}  // namespace catchlight::render
