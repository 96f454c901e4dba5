#include "catchlight/code_view.hpp"

namespace catchlight {
namespace {

/// The whole blocks of a part of the picture: the first one, and how many there are.
struct Blocks {
  glm::ivec2 first, count;
};

Blocks blocks_of(const CodeView& view, const PixelRect& rect) {
  const PixelRect inside = intersect(rect, {0, 0, view.width_px, view.height_px});
  const glm::ivec2 shift = view.block_shift, low(inside.x, inside.y), high(inside.x + inside.width, inside.y + inside.height);
  const glm::ivec2 first = (low + (glm::ivec2(1) << shift) - 1) >> shift;
  return {first, glm::max((high >> shift) - first, glm::ivec2(0))};
}

void add_luma_row(const CodeView& view, const PixelRect& rect, int y, std::vector<float>& luma) {
  const SampleView& first = view.samples[0];
  const float weight = view.luma_weights.x, offset = view.luma_of_zeros;
  const bool is_luma = view.luma_weights.y == 0 && view.luma_weights.z == 0;
  const std::size_t start = luma.size();
  luma.resize(start + static_cast<std::size_t>(rect.width));
  float* to = &luma[start];
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

CodePlanes code_planes(const CodeView& view, const PixelRect& rect) {
  const auto [first, count] = blocks_of(view, rect);
  const glm::ivec2 shift = view.block_shift;
  CodePlanes planes;
  planes.block_shift = shift;
  if (count.x == 0 || count.y == 0) return planes;
  planes.rect = {first.x << shift.x, first.y << shift.y, count.x << shift.x, count.y << shift.y};
  for (int y = planes.rect.y; y < planes.rect.y + planes.rect.height; ++y) add_luma_row(view, planes.rect, y, planes.luma);
  // Luma's own share falls out of the difference: colour does not depend on which of the block's pixels is asked.
  planes.color.reserve(static_cast<std::size_t>(count.x) * static_cast<std::size_t>(count.y));
  for (int y = planes.rect.y; y < planes.rect.y + planes.rect.height; y += 1 << shift.y)
    for (int x = planes.rect.x; x < planes.rect.x + planes.rect.width; x += 1 << shift.x) {
      const glm::vec3 samples = view.samples_at(x, y);
      const float luma = glm::dot(view.luma_weights, samples) + view.luma_of_zeros;
      planes.color.push_back(view.rgb_from_samples * samples + view.rgb_of_zeros - luma);
    }
  return planes;
}

}  // namespace catchlight
