// What a pixel holds, in codes and in light.
#pragma once

#include <string>

#include "app/media/pixels/frame.hpp"

namespace catchlight::app {

/// The largest code of the frame's own samples: 255, 1023, ...; 0 for floats, which have none.
int largest_code(const Frame& frame);

/// "120 118 110 = 0.188 0.181 0.156": the codes of a plate of one pixel, of `largest`, and the light that they mean under the
/// response, 1 = sensor white.
std::string codes_text(const Plate& pixel, int largest, const PlateColor& color);

/// codes_text() of a pixel of the frame.
std::string pixel_text(const Frame& frame, int x, int y);

}  // namespace catchlight::app
