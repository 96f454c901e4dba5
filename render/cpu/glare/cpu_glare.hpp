// Glare on processors: the face of every method.
#pragma once

#include "catchlight/camera.hpp"
#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"

namespace catchlight::render {

class CpuGlare {
 public:
  virtual ~CpuGlare() = default;

  /// Extracts what of `object` (premultiplied RGBA, exposed linear, the frame's pixels of `rect`) glares. `emission`: the
  /// object's own light among it, in the same pixels (RGB, or more channels); null where it glares as the rest. False where
  /// nothing glares, which is known after one look at the pixels.
  virtual bool extract(const Image& object, const Image* emission, const PixelRect& rect, int frame_width, int frame_height) = 0;

  /// Makes the glare; only after extract() was true. Gives the pixels of the frame that it reaches.
  virtual PixelRect spread(const CameraModel& camera) = 0;

  /// Writes the glare of the frame's pixels (x, y) to (x + count - 1, y): RGB, exposed linear light that is added. May be called
  /// from several threads at once.
  virtual void read_row(int x, int y, int count, float* rgb) const = 0;
};

}  // namespace catchlight::render
