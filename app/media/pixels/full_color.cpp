#include "app/media/pixels/full_color.hpp"

#include "app/media/pixels/convert.hpp"
#include "app/media/pixels/pixel_layout.hpp"

namespace catchlight::app {

Frame with_full_color(const Frame& frame) {
  const auto layout = pixel_layout(frame.picture().format);
  if (!layout || !layout->is_subsampled()) return frame;
  FramePtr rgb = convert(frame.picture(), layout->depth() > 8 ? AV_PIX_FMT_RGB48 : AV_PIX_FMT_RGB24);
  return {std::shared_ptr<const AVFrame>(std::move(rgb)), frame.number(), frame.time_s()};
}

}  // namespace catchlight::app
