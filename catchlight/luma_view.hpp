// The brightness of a frame, as the tracker looks at it.
#pragma once

#include <cstdint>

#include "catchlight/response.hpp"

namespace catchlight {

/// A luma plane as the decoder gave it: 8-bit codes, row-major, `stride` bytes a row.
/// `black_code` and `white_code` are the codes of 0 and 1 (16 and 235 in limited range, 0 and 255 in full range).
struct LumaView {
  const std::uint8_t* data = nullptr;
  int width_px = 0, height_px = 0, stride = 0;
  double black_code = 0, white_code = 255;
  TransferFunction transfer = TransferFunction::srgb;
};

}  // namespace catchlight
