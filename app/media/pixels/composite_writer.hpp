// Writes the changed pixels of a composite into a frame's own pixel format. Private to app/media.
#pragma once

#include "app/media/pixels/pixel_layout.hpp"
#include "catchlight/composite.hpp"
#include "catchlight/plate.hpp"

namespace catchlight::app {

/// `picture`: a writable copy of the frame, of which only samples under changed pixels are touched.
/// `plate`: reads what the composite was made on; it is asked for where pixels that share a chroma sample changed in part.
void write_composite(AVFrame& picture, const PixelLayout& layout, const Composite& composite, const PlateReader& plate);

}  // namespace catchlight::app
