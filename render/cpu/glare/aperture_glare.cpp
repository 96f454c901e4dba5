#include "render/cpu/glare/aperture_glare.hpp"

#include <algorithm>

namespace catchlight::render {

bool ApertureGlare::extract(const Image& object, const Image*, const PixelRect& rect, int frame_width, int frame_height) {
  excess_ = excess_of(object, rect, frame_width, frame_height, settings_);
  return excess_.has_value();
}

PixelRect ApertureGlare::spread(const CameraModel& camera) {
  glare_ = convolution_.spread(*excess_, camera);
  return lit_pixels(glare_);
}

void ApertureGlare::read_row(int x, int y, int count, float* rgb) const {
  std::copy_n(glare_.pixel(x, y), 3 * static_cast<std::ptrdiff_t>(count), rgb);
}

}  // namespace catchlight::render
