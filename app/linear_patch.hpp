// Footage codes to linear light, on the CPU, for small regions.
#pragma once

#include <vector>

#include "app/media/frame.hpp"

namespace catchlight::app {

/// RGB triples of `rect`, row-major, Rec. 709 primaries; 1 = sensor white.
std::vector<float> linear_rgb(const Frame& frame, const PixelRect& rect);

}  // namespace catchlight::app
