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

/// Unrounded codes of one row's pixels; from `begin` to before `end`, outside of which none has changed.
struct CodeRow {
  explicit CodeRow(int width) : changed(static_cast<std::size_t>(width)) {
    codes.fill(std::vector<double>(static_cast<std::size_t>(width)));
  }
  int begin = 0, end = 0;
  std::vector<std::uint8_t> changed;
  std::array<std::vector<double>, 3> codes;
};

/// Sums of the codes of the pixels that share a chroma sample, and how many of them changed: one row of such blocks.
struct BlockRow {
  explicit BlockRow(int blocks) : changed(static_cast<std::size_t>(blocks)) {
    sums.fill(std::vector<double>(static_cast<std::size_t>(blocks)));
  }

  void add(const CodeRow& row, int shift) {
    const auto begin = static_cast<std::size_t>(row.begin), end = static_cast<std::size_t>(row.end);
    for (std::size_t x = begin; x < end; ++x) {
      changed[x >> shift] += row.changed[x];
      sums[0][x >> shift] += row.codes[1][x];
      sums[1][x >> shift] += row.codes[2][x];
    }
  }

  std::vector<int> changed;
  std::array<std::vector<double>, 2> sums;
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
    CodeRow row(rect_.width);
    for (int y = rect_.y; y < rect_.y + rect_.height; ++y) {
      read(rect_.x, y, row);
      for (std::size_t i = 0; i < planes_.size(); ++i) write(rect_.x, y, row, i);
    }
  }

  /// Formats whose pixels share chroma samples. Of blocks that changed in part the plate is wanted.
  void write_subsampled(const PlateReader& plate_reader) const {
    const PixelRect blocks = blocks_of(layout_, rect_, picture_.width, picture_.height);
    const int block_height = 1 << layout_.chroma_shift_y;
    std::vector<PixelRect> partial;
    for (int y = blocks.y; y < blocks.y + blocks.height; y += block_height)
      write_block_row({blocks.x, y, blocks.width, std::min(block_height, picture_.height - y)}, partial);
    if (partial.empty()) return;
    PixelRect bounds;
    for (const PixelRect& block : partial) bounds = unite(bounds, block);
    const Plate plate = plate_reader(bounds);
    for (const PixelRect& block : partial) move_chroma(plate, block);
  }

 private:
  int components() const { return layout_.model == ColorModel::gray ? 1 : 3; }

  int rounded(double code) const { return static_cast<int>(std::lround(std::clamp(code, 0.0, code_from_rgb_.max_code()))); }

  /// The codes of the pixels from column `x` on, as many as the row holds.
  void read(int x, int y, CodeRow& row) const {
    row.begin = row.end = 0;
    if (y < rect_.y || y >= rect_.y + rect_.height) return;
    const int left = std::max(rect_.x - x, 0);
    const int right = std::min(rect_.x + rect_.width - x, static_cast<int>(row.changed.size()));
    const float* rgba = pixels_.at(x + left, y);
    for (int i = left; i < right; ++i) row.changed[static_cast<std::size_t>(i)] = rgba[4 * (i - left) + 3] > 0.5f;
    const auto is_changed = [&](int i) { return row.changed[static_cast<std::size_t>(i)] != 0; };
    for (row.begin = left; row.begin < right && !is_changed(row.begin);) ++row.begin;
    for (row.end = right; row.end > row.begin && !is_changed(row.end - 1);) --row.end;
    const auto codes = [&](std::size_t component) { return row.codes[component].data() + row.begin; };
    code_from_rgb_.row(rgba + 4 * (row.begin - left), row.end - row.begin, {codes(0), codes(1), codes(2)});
  }

  void write(int x, int y, const CodeRow& row, std::size_t component) const {
    planes_[component].set_codes(x + row.begin, y, row.codes[component].data() + row.begin, row.changed.data() + row.begin,
                                 row.end - row.begin, code_from_rgb_.max_code());
  }

  /// Luma of a row of blocks, and the chroma of those that changed as a whole; adds those that changed in part to `partial`.
  void write_block_row(const PixelRect& area, std::vector<PixelRect>& partial) const {
    const int shift = layout_.chroma_shift_x, block_width = 1 << shift;
    CodeRow row(area.width);
    BlockRow blocks((area.width + block_width - 1) >> shift);
    for (int y = area.y; y < area.y + area.height; ++y) {
      read(area.x, y, row);
      write(area.x, y, row, 0);
      blocks.add(row, shift);
    }
    for (std::size_t i = 0; i < blocks.changed.size(); ++i) {
      if (blocks.changed[i] == 0) continue;
      const PixelRect block = intersect({area.x + (static_cast<int>(i) << shift), area.y, block_width, area.height}, area);
      const int pixels = block.width * block.height;
      if (blocks.changed[i] == pixels)
        set_chroma(block, blocks.sums[0][i] / pixels, blocks.sums[1][i] / pixels);
      else
        partial.push_back(block);
    }
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
