// One picture of the footage, as tracking and photometry look at it: no word of the format or the file that it came from.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "catchlight/luma_view.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/plate.hpp"

namespace catchlight {

/// The codes of part of a frame as they were stored: luma of every pixel, and colour at the resolution that the format has. A
/// pixel's RGB code is luma + color of its block. All normalised: 0 is the stream's black, 1 its white.
struct CodePlanes {
  PixelRect rect;                ///< whole blocks, within the rectangle that was asked for
  glm::ivec2 block_shift{0};     ///< log2 of the pixels of a block: (1, 1) where the format is 4:2:0
  std::vector<float> luma;       ///< row-major
  std::vector<glm::vec3> color;  ///< RGB less luma, a value a block, row-major
  glm::dmat3 rounding{0.0};      ///< covariance of RGB that comes of rounding to whole codes

  int blocks_across() const { return rect.width >> block_shift.x; }
};

class FrameImage {
 public:
  virtual ~FrameImage() = default;

  /// 8 bits, for the tracker; the view lives as long as the picture.
  virtual LumaView luma() const = 0;

  /// RGB codes of the part of the frame that lies in `rect`.
  virtual Plate rgb(const PixelRect& rect) const = 0;

  virtual CodePlanes code_planes(const PixelRect& rect) const = 0;

  /// How the codes stand for light.
  virtual PlateColor color() const = 0;
};

}  // namespace catchlight
