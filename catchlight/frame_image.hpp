// One picture of the footage, as tracking and photometry look at it: no word of the format or the file that it came from.
#pragma once

#include "catchlight/code_view.hpp"
#include "catchlight/luma_view.hpp"
#include "catchlight/plate.hpp"

namespace catchlight {

class FrameImage {
 public:
  virtual ~FrameImage() = default;

  /// 8 bits, for the tracker; the view lives as long as the picture.
  virtual LumaView luma() const = 0;

  /// Every code as it was stored; the view lives as long as the picture.
  virtual CodeView codes() const = 0;

  /// How the codes stand for light.
  virtual PlateColor color() const = 0;
};

}  // namespace catchlight
