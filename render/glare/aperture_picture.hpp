// Apertures: what stands in the light's way in a lens or an eye.
#pragma once

#include <functional>
#include <string>

#include "catchlight/image.hpp"

namespace catchlight::render {

struct AperturePicture {
  int most_px;                             ///< a file's own size; what is drawn has no end
  std::function<Image(int size_px)> draw;  ///< square, one channel, 0 (opaque) to 1; size_px from 1 to most_px
};

/// "circle", "blades:N" (N from 3 to 24), "eyelashes", "dust", or a square picture: PNG of 8 or 16 bits or another that OpenCV
/// reads, OpenEXR; luminance of its values (not of the light that they code) is how much of the wave passes. Throws Error naming
/// it: what is wrong with N, no such file, unreadable, not square, black all over, negative or not finite.
AperturePicture aperture_picture(const std::string& name);

}  // namespace catchlight::render
