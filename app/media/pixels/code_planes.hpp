// The codes of part of a frame as they were stored: luma of every pixel, and colour at the resolution that the format has.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "app/media/pixels/frame.hpp"
#include "catchlight/pixel_rect.hpp"

namespace catchlight::app {

/// A pixel's RGB code is luma + color of its block. All normalised: 0 is the stream's black, 1 its white.
struct CodePlanes {
  PixelRect rect;                ///< of whole blocks, within the one that was asked for
  glm::ivec2 block_shift{0};     ///< log2 of the pixels of a block: (1, 1) where the format is 4:2:0
  std::vector<float> luma;       ///< row-major
  std::vector<glm::vec3> color;  ///< RGB less luma, a value a block, row-major
  glm::dmat3 rounding{0.0};      ///< covariance of RGB that comes of rounding to whole codes

  int blocks_across() const { return rect.width >> block_shift.x; }
};

CodePlanes code_planes(const Frame& frame, const PixelRect& rect);

}  // namespace catchlight::app
