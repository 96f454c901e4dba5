// Footage codes to linear light and back, on the CPU.
#pragma once

#include <vector>

#include "app/media/pixels/frame.hpp"
#include "catchlight/color.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/plate.hpp"

namespace catchlight::app {

/// RGB triples of `rect`, row-major, Rec. 709 primaries; 1 = sensor white.
std::vector<float> linear_rgb(const Frame& frame, const PixelRect& rect);

/// Light from which on the sensor may have clipped: that of code 250 of 255. Infinite for floats, which do not end at 1.
glm::dvec3 clipped_linear(const Frame& frame);

/// The inverse of linear_from_code(); light below 0 that has no code there (all but sRGB and linear) gets black's.
double code_from_linear(TransferFunction transfer, double linear);

/// Both ways by the footage's response, formula or curve.
double linear_from_code(const PlateColor& color, double code, int channel);
double code_from_linear(const PlateColor& color, double linear, int channel);

}  // namespace catchlight::app
