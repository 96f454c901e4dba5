#include "catchlight/code_view.hpp"

namespace catchlight {
namespace {

void make_luma_row(const CodeView& view, const PixelRect& rect, int y, float* to) {
  const SampleView& first = view.samples[0];
  const float weight = view.luma_weights.x, offset = view.luma_of_zeros;
  const bool is_luma = view.luma_weights.y == 0 && view.luma_weights.z == 0;
  if (is_luma && first.kind == SampleView::Kind::byte && first.step_bytes == 1) {
    const std::uint8_t* from = first.data + y * first.stride_bytes + rect.x;
    for (int x = 0; x < rect.width; ++x) to[x] = weight * from[x] + offset;
  } else if (is_luma) {
    for (int x = 0; x < rect.width; ++x) to[x] = weight * first.at(rect.x + x, y) + offset;
  } else {
    for (int x = 0; x < rect.width; ++x) to[x] = glm::dot(view.luma_weights, view.samples_at(rect.x + x, y)) + offset;
  }
}

}  // namespace

PixelRect CodeView::whole_blocks(const PixelRect& rect) const {
  const PixelRect inside = intersect(rect, {0, 0, width_px, height_px});
  const int sx = block_shift.x, sy = block_shift.y;
  const int left = (inside.x + (1 << sx) - 1) >> sx, top = (inside.y + (1 << sy) - 1) >> sy;
  const int right = (inside.x + inside.width) >> sx, bottom = (inside.y + inside.height) >> sy;
  if (right <= left || bottom <= top) return {};
  return {left << sx, top << sy, (right - left) << sx, (bottom - top) << sy};
}

std::vector<float> luma_of(const CodeView& view, const PixelRect& rect) {
  std::vector<float> luma(static_cast<std::size_t>(rect.width) * static_cast<std::size_t>(rect.height));
  for (int y = 0; y < rect.height; ++y)
    make_luma_row(view, rect, rect.y + y, &luma[static_cast<std::size_t>(y) * static_cast<std::size_t>(rect.width)]);
  return luma;
}

}  // namespace catchlight
