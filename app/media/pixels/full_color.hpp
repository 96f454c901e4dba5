// Footage whose colour is subsampled, as one that has a colour for every pixel.
#pragma once

#include "app/media/pixels/frame.hpp"

namespace catchlight::app {

/// RGB codes, 8 bits or 16, as Frame::rgb() gives them; a frame that already has a colour for every pixel as it is.
Frame with_full_color(const Frame& frame);

}  // namespace catchlight::app
