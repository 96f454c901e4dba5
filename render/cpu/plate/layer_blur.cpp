#include "render/cpu/plate/layer_blur.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/util/parallel.hpp"
#include "render/math/float4.hpp"

namespace catchlight::render {
namespace {

constexpr int kChannels = 4;

PixelRect grown(const PixelRect& rect, int across, int down, const Image& image) {
  return intersect({rect.x - across, rect.y - down, rect.width + 2 * across, rect.height + 2 * down},
                   {0, 0, image.width, image.height});
}

template <typename Work>
void for_rows(const PixelRect& rect, const Work& work) {
  constexpr int kRows = 8;
  parallel_for(static_cast<std::size_t>((rect.height + kRows - 1) / kRows), 0, [&](std::size_t band) {
    const int first = rect.y + static_cast<int>(band) * kRows;
    for (int y = first; y < std::min(first + kRows, rect.y + rect.height); ++y) work(y);
  });
}

/// Steps of a pixel along the longer axis of the motion, with the weights (all alike but the two outermost) whose variance is the
/// box's, length^2 / 12; linear between pixels across.
struct MotionTaps {
  bool steep;
  int reach;
  float slope, each, ends;

  explicit MotionTaps(const glm::vec2& motion_px) : steep(std::abs(motion_px.y) > std::abs(motion_px.x)) {
    const float length_px = std::min(std::max(std::abs(motion_px.x), std::abs(motion_px.y)), float{kMaxMotion_px});
    reach = static_cast<int>(std::ceil(0.5f * (std::sqrt(1 + length_px * length_px) - 1) - 1e-6f));
    slope = reach == 0 ? 0 : steep ? motion_px.x / motion_px.y : motion_px.y / motion_px.x;
    const float variance = length_px * length_px / 12, k = static_cast<float>(reach), inner = (k - 1) * k / 3;
    ends = reach == 0 ? 0 : (variance - inner) / (k * k - inner);
    each = reach == 0 ? 1 : (1 - ends) / (2 * k - 1);
  }
};

Float4 mean_along(const Image& image, int x, int y, const MotionTaps& taps) {
  const auto fetch = [&](int u, int v) {
    return load(image.pixel(std::clamp(u, 0, image.width - 1), std::clamp(v, 0, image.height - 1)));
  };
  if (taps.reach == 0) return fetch(x, y);
  Float4 sum{};
  for (int i = -taps.reach; i <= taps.reach; ++i) {
    const float across = static_cast<float>(i) * taps.slope, low = std::floor(across), share = across - low;
    const int u = x + (taps.steep ? static_cast<int>(low) : i), v = y + (taps.steep ? i : static_cast<int>(low));
    Float4 light = fetch(u, v);
    if (share > 0) light = blend(light, taps.steep ? fetch(u + 1, v) : fetch(u, v + 1), share);
    sum += splat(std::abs(i) == taps.reach ? 0.5f * taps.ends : taps.each) * light;
  }
  return sum;
}

/// to[i] += weight * (a[i] + b[i])
[[gnu::target_clones("avx2", "default")]] void add_pair(int count, float weight, const float* __restrict a,
                                                        const float* __restrict b, float* __restrict to) {
  for (int i = 0; i < count; ++i) to[i] += weight * (a[i] + b[i]);
}

[[gnu::target_clones("avx2", "default")]] void set_scaled(int count, float weight, const float* __restrict from,
                                                          float* __restrict to) {
  for (int i = 0; i < count; ++i) to[i] = weight * from[i];
}

/// Blurs the pixels of `row` along it; the first and last pixels go on beyond the image.
void blur_row(const Image& image, const PixelRect& row, const std::vector<float>& weights, float* to) {
  const int reach = static_cast<int>(weights.size()) - 1;
  thread_local std::vector<float> padded;
  padded.resize(static_cast<std::size_t>(kChannels) * (row.width + 2 * reach));
  for (int x = row.x - reach; x < row.x + row.width + reach; ++x) {
    if (x >= 0 && x < image.width) continue;
    std::copy_n(image.pixel(std::clamp(x, 0, image.width - 1), row.y), kChannels, &padded[kChannels * (x - row.x + reach)]);
  }
  const int first = std::max(row.x - reach, 0), last = std::min(row.x + row.width + reach, image.width);
  std::copy_n(image.pixel(first, row.y), kChannels * (last - first), &padded[kChannels * (first - row.x + reach)]);
  const float* middle = &padded[static_cast<std::size_t>(kChannels) * reach];
  set_scaled(kChannels * row.width, weights[0], middle, to);
  for (int i = 1; i <= reach; ++i)
    add_pair(kChannels * row.width, weights[static_cast<std::size_t>(i)], middle + kChannels * i, middle - kChannels * i, to);
}

}  // namespace

void LayerBlur::defocus(Image& image, std::span<const PixelRect> active, const std::vector<float>& weights) {
  const int reach = static_cast<int>(weights.size()) - 1;
  // The columns that each row needs: those of the bands whose blur reaches it.
  std::vector<PixelRect> rows(static_cast<std::size_t>(image.height));
  for (const PixelRect& band : active) {
    const PixelRect reached = grown(band, reach, reach, image);
    for (int y = reached.y; y < reached.y + reached.height; ++y)
      rows[static_cast<std::size_t>(y)] = unite(rows[static_cast<std::size_t>(y)], {reached.x, y, reached.width, 1});
  }
  PixelRect all;
  for (const PixelRect& row : rows) all = unite(all, row);
  if (all.empty()) return;
  // Rows into the scratch, which has `reach` rows more above and below, then columns back.
  const PixelRect read = grown(all, 0, reach, image);
  scratch_.resize(static_cast<std::size_t>(kChannels) * read.width * read.height);
  const auto scratch_row = [&](int y) { return &scratch_[static_cast<std::size_t>(kChannels) * (y - read.y) * read.width]; };
  for_rows(read, [&](int y) {
    PixelRect row;
    for (int near = std::max(y - reach, 0); near <= std::min(y + reach, image.height - 1); ++near) {
      PixelRect wanted = rows[static_cast<std::size_t>(near)];
      wanted.y = y;
      row = unite(row, wanted);
    }
    if (!row.empty()) blur_row(image, row, weights, scratch_row(y) + kChannels * (row.x - read.x));
  });
  for_rows(all, [&](int y) {
    const PixelRect& row = rows[static_cast<std::size_t>(y)];
    if (row.empty()) return;
    const auto at = [&](int from) { return scratch_row(std::clamp(from, 0, image.height - 1)) + kChannels * (row.x - read.x); };
    set_scaled(kChannels * row.width, weights[0], at(y), image.pixel(row.x, y));
    for (int i = 1; i <= reach; ++i)
      add_pair(kChannels * row.width, weights[static_cast<std::size_t>(i)], at(y + i), at(y - i), image.pixel(row.x, y));
  });
}

void LayerBlur::move(Image& image, const PixelRect& active, const MotionField& motion, const glm::dvec2& corner_px) {
  const double longest =
      std::max({glm::length(motion.at(corner_px + glm::dvec2(active.x, active.y))),
                glm::length(motion.at(corner_px + glm::dvec2(active.x + active.width, active.y))),
                glm::length(motion.at(corner_px + glm::dvec2(active.x, active.y + active.height))),
                glm::length(motion.at(corner_px + glm::dvec2(active.x + active.width, active.y + active.height)))});
  const int reach = static_cast<int>(std::ceil(std::min(longest, kMaxMotion_px))) + 2;
  const PixelRect all = grown(active, reach, reach, image);
  if (all.empty()) return;
  scratch_.resize(static_cast<std::size_t>(kChannels) * all.width * all.height);
  const auto scratch_row = [&](int y) { return &scratch_[static_cast<std::size_t>(kChannels) * (y - all.y) * all.width]; };
  for_rows(all, [&](int y) {
    for (int x = all.x; x < all.x + all.width; ++x)
      store(mean_along(image, x, y, MotionTaps(glm::vec2(motion.at(corner_px + glm::dvec2(x, y))))),
            scratch_row(y) + kChannels * (x - all.x));
  });
  for_rows(all, [&](int y) { std::copy_n(scratch_row(y), kChannels * all.width, image.pixel(all.x, y)); });
}

}  // namespace catchlight::render
