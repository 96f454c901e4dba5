// Writes the changed pixels of a composite into a frame's own pixel format. Private to app/media.
#pragma once

#include "app/media/pixels/pixel_layout.hpp"
#include "catchlight/composite.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/plate.hpp"

namespace catchlight::app {

/// `picture`: a writable copy of the frame, of which only samples under changed pixels are touched.
/// `plate`: what the composite was made on, RGB codes of a rectangle that covers `blocks_of(layout, ...)`; read for subsampled
/// formats only.
void write_composite(AVFrame& picture, const PixelLayout& layout, const Composite& composite, const Plate& plate);

/// The smallest rectangle of whole chroma samples around `rect`, within the frame.
PixelRect blocks_of(const PixelLayout& layout, const PixelRect& rect, int width_px, int height_px);

}  // namespace catchlight::app
