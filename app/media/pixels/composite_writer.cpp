#include "app/media/pixels/composite_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "app/media/pixels/color_tags.hpp"
#include "catchlight/color.hpp"

extern "C" {
#include <libavutil/frame.h>
}

namespace catchlight::app {
namespace {

// The composite, addressed by the frame's pixels.
class ChangedPixels {
 public:
  explicit ChangedPixels(const Composite& composite) : composite_(composite) {}

  bool changed(int x, int y) const {
    const PixelRect& rect = composite_.rect;
    return x >= rect.x && y >= rect.y && x < rect.x + rect.width && y < rect.y + rect.height && at(x, y)[3] > 0.5f;
  }
  /// The plate that was kept of these pixels; null if it was not.
  const Plate* plate_of(const PixelRect& rect) const {
    const Plate* plate = composite_.plate.get();
    return plate && intersect(rect, plate->rect) == rect ? plate : nullptr;
  }
  glm::dvec3 raw(int x, int y) const { return {at(x, y)[0], at(x, y)[1], at(x, y)[2]}; }

  glm::dvec3 rgb(int x, int y) const { return {code_of(at(x, y)[0]), code_of(at(x, y)[1]), code_of(at(x, y)[2])}; }

  const float* at(int x, int y) const {
    const PixelRect& rect = composite_.rect;
    const auto pixel =
        static_cast<std::size_t>(y - rect.y) * static_cast<std::size_t>(rect.width) + static_cast<std::size_t>(x - rect.x);
    return composite_.rgba.data() + 4 * pixel;
  }

 private:
  const Composite& composite_;
};

glm::dvec3 plate_rgb(const Plate& plate, int x, int y) {
  const auto first = 3 * (static_cast<std::size_t>(y - plate.rect.y) * static_cast<std::size_t>(plate.rect.width) +
                          static_cast<std::size_t>(x - plate.rect.x));
  glm::dvec3 rgb;
  for (std::size_t i = 0; i < 3; ++i) {
    if (plate.format == Plate::Format::rgb_u8) {
      rgb[static_cast<int>(i)] = std::to_integer<int>(plate.pixels[first + i]) / 255.0;
    } else {
      std::uint16_t code;
      std::memcpy(&code, plate.pixels.data() + 2 * (first + i), sizeof code);
      rgb[static_cast<int>(i)] = code / 65535.0;
    }
  }
  return rgb;
}

template <class Visit>
void for_each_pixel(const PixelRect& rect, Visit visit) {
  for (int y = rect.y; y < rect.y + rect.height; ++y) {
    for (int x = rect.x; x < rect.x + rect.width; ++x) visit(x, y);
  }
}

/// The smallest rectangle of whole chroma samples around `rect`, within the frame.
PixelRect blocks_of(const PixelLayout& layout, const PixelRect& rect, int width_px, int height_px) {
  const int mask_x = (1 << layout.chroma_shift_x) - 1, mask_y = (1 << layout.chroma_shift_y) - 1;
  const int x = rect.x & ~mask_x, y = rect.y & ~mask_y;
  const int right = (rect.x + rect.width + mask_x) & ~mask_x, bottom = (rect.y + rect.height + mask_y) & ~mask_y;
  return intersect({x, y, right - x, bottom - y}, {0, 0, width_px, height_px});
}

[[gnu::target_clones("avx2", "default")]] void mark_changed(const float* rgba, int count, std::uint8_t* changed) {
  for (int i = 0; i < count; ++i) changed[i] = rgba[4 * i + 3] > 0.5f;
}

/// Adds each pair of values to one sum.
template <class Value, class Sum>
inline void add_pairs(const Value* values, std::size_t pairs, Sum* sums) {
  for (std::size_t i = 0; i < pairs; ++i) sums[i] = sums[i] + values[2 * i] + values[2 * i + 1];
}

[[gnu::target_clones("avx2", "default")]] void add_code_pairs(const float* codes, std::size_t pairs, float* sums) {
  add_pairs(codes, pairs, sums);
}

/// Unrounded codes of one row's pixels; from `begin` to before `end`, outside of which none has changed.
struct CodeRow {
  /// Whole blocks of pixels may be read, also where the last one ends beyond the row.
  CodeRow(int width, int shift) : changed(static_cast<std::size_t>(width + (1 << shift) - 1)) {
    codes.fill(std::vector<float>(changed.size()));
  }
  bool empty() const { return begin == end; }

  int begin = 0, end = 0;
  std::vector<std::uint8_t> changed;
  std::array<std::vector<float>, 3> codes;
};

/// What the pixels that share a chroma sample have in common: one row of such blocks.
class BlockRow {
 public:
  BlockRow(int width, int shift) : shift_(shift), counts_(static_cast<std::size_t>((width + (1 << shift) - 1) >> shift)) {
    means_.fill(std::vector<float>(counts_.size()));
    is_whole_.resize(counts_.size());
  }

  void clear() {
    const auto reset = [&](auto& values) { std::fill(values.begin() + begin_, values.begin() + end_, 0); };
    if (!empty()) reset(counts_), reset(means_[0]), reset(means_[1]);
    begin_ = static_cast<std::ptrdiff_t>(counts_.size()), end_ = 0;
  }

  void add(const CodeRow& row) {
    const std::ptrdiff_t begin = row.begin >> shift_, end = ((row.end - 1) >> shift_) + 1;
    begin_ = std::min(begin_, begin), end_ = std::max(end_, end);
    const auto first = static_cast<std::size_t>(begin), last = static_cast<std::size_t>(end), from = first << shift_;
    if (shift_ == 1) {
      add_pairs(&row.changed[from], last - first, &counts_[first]);
      for (std::size_t i = 0; i < 2; ++i) add_code_pairs(&row.codes[i + 1][from], last - first, &means_[i][first]);
      return;
    }
    for (std::size_t x = from; x < last << shift_; ++x) {
      counts_[x >> shift_] += row.changed[x];
      for (std::size_t i = 0; i < 2; ++i) means_[i][x >> shift_] += row.codes[i + 1][x];
    }
  }

  /// Sums become means, as of `height` rows of pixels of which the last block may lack some; calls on_part(block) for each
  /// that changed in part.
  template <class OnPart>
  void finish(int width, int height, const OnPart& on_part) {
    const int narrow = width & ((1 << shift_) - 1), last = narrow != 0 ? static_cast<int>(counts_.size()) - 1 : end();
    finish(begin(), std::min(end(), last), height << shift_, on_part);
    if (last < end()) finish(last, end(), height * narrow, on_part);
  }

  bool empty() const { return begin_ >= end_; }
  int begin() const { return static_cast<int>(begin_); }
  int count() const { return static_cast<int>(end_ - begin_); }
  const float* means(std::size_t component) const { return means_[component].data() + begin_; }
  const std::uint8_t* is_whole() const { return is_whole_.data() + begin_; }

 private:
  int end() const { return static_cast<int>(end_); }

  template <class OnPart>
  void finish(int begin, int end, int pixels, const OnPart& on_part) {
    const float share = 1.0f / static_cast<float>(pixels);
    for (std::vector<float>& means : means_)
      for (int i = begin; i < end; ++i) means[static_cast<std::size_t>(i)] *= share;
    for (int i = begin; i < end; ++i) {
      const std::uint8_t count = counts_[static_cast<std::size_t>(i)];
      is_whole_[static_cast<std::size_t>(i)] = count == pixels;
      if (count != 0 && count != pixels) on_part(i);
    }
  }

  int shift_;
  std::ptrdiff_t begin_ = 0, end_ = 0;  ///< blocks outside of which none has changed
  std::vector<std::uint8_t> counts_;    ///< of pixels that changed
  std::array<std::vector<float>, 2> means_;
  std::vector<std::uint8_t> is_whole_;  ///< changed in all its pixels
};

class CompositeWriter {
 public:
  CompositeWriter(AVFrame& picture, const PixelLayout& layout, const Composite& composite)
      : picture_(picture),
        layout_(layout),
        pixels_(composite),
        rect_(intersect(composite.rect, {0, 0, picture.width, picture.height})),
        code_from_rgb_(picture, layout) {
    for (int i = 0; i < components(); ++i) planes_.emplace_back(picture, layout, i);
  }

  void write_values() const {
    for (int i = 0; i < components(); ++i) {
      for_each_pixel(rect_, [&](int x, int y) {
        if (!pixels_.changed(x, y)) return;
        const glm::dvec3 rgb = pixels_.raw(x, y);
        planes_[static_cast<std::size_t>(i)].set_value(
            x, y, static_cast<float>(layout_.model == ColorModel::gray ? glm::dot(kLuminanceWeights, rgb) : rgb[i]));
      });
    }
  }

  /// Formats with a sample of every component for every pixel.
  void write_full_resolution() const {
    CodeRow row(rect_.width, 0);
    for (int y = rect_.y; y < rect_.y + rect_.height; ++y) {
      read(rect_.x, y, rect_.width, row);
      for (std::size_t i = 0; i < planes_.size(); ++i) write(rect_.x, y, row, i);
    }
  }

  /// Formats whose pixels share chroma samples. Of blocks that changed in part the plate is wanted.
  void write_subsampled(const PlateReader& plate_reader) const {
    const PixelRect blocks = blocks_of(layout_, rect_, picture_.width, picture_.height);
    const int block_height = 1 << layout_.chroma_shift_y;
    CodeRow row(blocks.width, layout_.chroma_shift_x);
    BlockRow block_row(blocks.width, layout_.chroma_shift_x);
    std::vector<PixelRect> partial;
    for (int y = blocks.y; y < blocks.y + blocks.height; y += block_height)
      write_block_row({blocks.x, y, blocks.width, std::min(block_height, picture_.height - y)}, row, block_row, partial);
    if (partial.empty()) return;
    PixelRect bounds;
    for (const PixelRect& block : partial) bounds = unite(bounds, block);
    bounds = intersect(bounds, rect_);
    const Plate* kept = pixels_.plate_of(bounds);
    const Plate read = kept ? Plate{} : plate_reader(bounds);
    for (const PixelRect& block : partial) move_chroma(kept ? *kept : read, block);
  }

 private:
  int components() const { return layout_.model == ColorModel::gray ? 1 : 3; }

  int rounded(double code) const { return static_cast<int>(std::lround(std::clamp(code, 0.0, code_from_rgb_.max_code()))); }

  /// The codes of `width` pixels from column `x` on.
  void read(int x, int y, int width, CodeRow& row) const {
    row.begin = row.end = 0;
    if (y < rect_.y || y >= rect_.y + rect_.height) return;
    const int left = std::max(rect_.x - x, 0), right = std::min(rect_.x + rect_.width - x, width);
    const float* rgba = pixels_.at(x + left, y);
    std::uint8_t* changed = row.changed.data();
    mark_changed(rgba, right - left, changed + left);
    row.begin = static_cast<int>(std::find(changed + left, changed + right, 1) - changed);
    for (row.end = right; row.end > row.begin && changed[row.end - 1] == 0;) --row.end;
    const auto codes = [&](std::size_t component) { return row.codes[component].data() + row.begin; };
    code_from_rgb_.row(rgba + 4 * (row.begin - left), row.end - row.begin, {codes(0), codes(1), codes(2)});
  }

  void write(int x, int y, const CodeRow& row, std::size_t component) const {
    planes_[component].set_codes(x + row.begin, y, row.codes[component].data() + row.begin, row.changed.data() + row.begin,
                                 row.end - row.begin);
  }

  /// Luma of a row of blocks, and the chroma of those that changed as a whole; adds those that changed in part to `partial`.
  void write_block_row(const PixelRect& area, CodeRow& row, BlockRow& blocks, std::vector<PixelRect>& partial) const {
    const int shift = layout_.chroma_shift_x;
    blocks.clear();
    for (int y = area.y; y < area.y + area.height; ++y) {
      read(area.x, y, area.width, row);
      if (row.empty()) continue;
      write(area.x, y, row, 0);
      blocks.add(row);
    }
    if (blocks.empty()) return;
    blocks.finish(area.width, area.height, [&](int i) {
      partial.push_back(intersect({area.x + (i << shift), area.y, 1 << shift, area.height}, area));
    });
    const int x = (area.x >> shift) + blocks.begin(), y = area.y >> layout_.chroma_shift_y;
    for (std::size_t i = 0; i < 2; ++i) planes_[i + 1].set_codes(x, y, blocks.means(i), blocks.is_whole(), blocks.count());
  }

  void set_chroma(const PixelRect& block, double blue, double red) const {
    const int x = block.x >> layout_.chroma_shift_x, y = block.y >> layout_.chroma_shift_y;
    planes_[1].set_code(x, y, rounded(blue));
    planes_[2].set_code(x, y, rounded(red));
  }

  /// `block`: the pixels that share one chroma sample, of which some changed.
  void move_chroma(const Plate& plate, const PixelRect& block) const {
    glm::dvec3 moved(0.0);
    for_each_pixel(block, [&](int x, int y) {
      if (pixels_.changed(x, y)) moved += code_from_rgb_(pixels_.rgb(x, y)) - code_from_rgb_(plate_rgb(plate, x, y));
    });
    const int pixels = block.width * block.height;
    const int x = block.x >> layout_.chroma_shift_x, y = block.y >> layout_.chroma_shift_y;
    set_chroma(block, planes_[1].code(x, y) + moved[1] / pixels, planes_[2].code(x, y) + moved[2] / pixels);
  }

  AVFrame& picture_;
  const PixelLayout& layout_;
  ChangedPixels pixels_;
  PixelRect rect_;
  CodeFromRgb code_from_rgb_;
  std::vector<SamplePlane> planes_;
};

}  // namespace

void write_composite(AVFrame& picture, const PixelLayout& layout, const Composite& composite, const PlateReader& plate) {
  const CompositeWriter writer(picture, layout, composite);
  if (layout.is_float)
    writer.write_values();
  else if (layout.is_subsampled())
    writer.write_subsampled(plate);
  else
    writer.write_full_resolution();
}

}  // namespace catchlight::app
