#include "app/media/pixels/composite_writer.hpp"

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

  // What is not a number becomes black rather than undefined.
  glm::dvec3 rgb(int x, int y) const {
    const auto clamped = [](float code) { return code > 0 ? std::min(static_cast<double>(code), 1.0) : 0.0; };
    return {clamped(at(x, y)[0]), clamped(at(x, y)[1]), clamped(at(x, y)[2])};
  }

 private:
  const float* at(int x, int y) const {
    const PixelRect& rect = composite_.rect;
    const auto pixel =
        static_cast<std::size_t>(y - rect.y) * static_cast<std::size_t>(rect.width) + static_cast<std::size_t>(x - rect.x);
    return composite_.rgba.data() + 4 * pixel;
  }
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

class CompositeWriter {
 public:
  CompositeWriter(AVFrame& picture, const PixelLayout& layout, const Composite& composite)
      : picture_(picture),
        layout_(layout),
        pixels_(composite),
        rect_(intersect(composite.rect, {0, 0, picture.width, picture.height})),
        code_from_rgb_(picture, layout) {}

  void write_values() const {
    for (int i = 0; i < components(); ++i) {
      const SamplePlane plane(picture_, layout_, i);
      for_each_pixel(rect_, [&](int x, int y) {
        if (!pixels_.changed(x, y)) return;
        const glm::dvec3 rgb = pixels_.raw(x, y);
        plane.set_value(x, y, static_cast<float>(layout_.model == ColorModel::gray ? glm::dot(kLuminanceWeights, rgb) : rgb[i]));
      });
    }
  }

  // The components that have a sample for every pixel.
  void write_full_resolution() const {
    for (int i = 0; i < (layout_.is_subsampled() ? 1 : components()); ++i) {
      const SamplePlane plane(picture_, layout_, i);
      for_each_pixel(rect_, [&](int x, int y) {
        if (pixels_.changed(x, y)) plane.set_code(x, y, rounded(code_from_rgb_(pixels_.rgb(x, y))[i]));
      });
    }
  }

  void write_subsampled(const Plate& plate) const {
    const PixelRect blocks = blocks_of(layout_, rect_, picture_.width, picture_.height);
    const int block_width = 1 << layout_.chroma_shift_x, block_height = 1 << layout_.chroma_shift_y;
    for (int y = blocks.y; y < blocks.y + blocks.height; y += block_height) {
      for (int x = blocks.x; x < blocks.x + blocks.width; x += block_width) {
        write_chroma(plate, intersect({x, y, block_width, block_height}, {0, 0, picture_.width, picture_.height}));
      }
    }
  }

 private:
  int components() const { return layout_.model == ColorModel::gray ? 1 : 3; }

  int rounded(double code) const { return static_cast<int>(std::lround(std::clamp(code, 0.0, code_from_rgb_.max_code()))); }

  // `block`: the pixels that share one chroma sample.
  void write_chroma(const Plate& plate, const PixelRect& block) const {
    int changed = 0;
    glm::dvec3 sum(0.0), moved(0.0);
    for_each_pixel(block, [&](int x, int y) {
      if (!pixels_.changed(x, y)) return;
      ++changed;
      const glm::dvec3 codes = code_from_rgb_(pixels_.rgb(x, y));
      sum += codes;
      moved += codes - code_from_rgb_(plate_rgb(plate, x, y));
    });
    if (changed == 0) return;
    const int pixels = block.width * block.height;
    for (int i = 1; i < 3; ++i) {
      const SamplePlane plane(picture_, layout_, i);
      const int x = block.x >> layout_.chroma_shift_x, y = block.y >> layout_.chroma_shift_y;
      plane.set_code(x, y, rounded(changed == pixels ? sum[i] / pixels : plane.code(x, y) + moved[i] / pixels));
    }
  }

  AVFrame& picture_;
  const PixelLayout& layout_;
  ChangedPixels pixels_;
  PixelRect rect_;
  CodeFromRgb code_from_rgb_;
};

}  // namespace

PixelRect blocks_of(const PixelLayout& layout, const PixelRect& rect, int width_px, int height_px) {
  const int mask_x = (1 << layout.chroma_shift_x) - 1, mask_y = (1 << layout.chroma_shift_y) - 1;
  const int x = rect.x & ~mask_x, y = rect.y & ~mask_y;
  const int right = (rect.x + rect.width + mask_x) & ~mask_x, bottom = (rect.y + rect.height + mask_y) & ~mask_y;
  return intersect({x, y, right - x, bottom - y}, {0, 0, width_px, height_px});
}

void write_composite(AVFrame& picture, const PixelLayout& layout, const Composite& composite, const Plate& plate) {
  const CompositeWriter writer(picture, layout, composite);
  if (layout.is_float) {
    writer.write_values();
    return;
  }
  writer.write_full_resolution();
  if (layout.is_subsampled()) writer.write_subsampled(plate);
}

}  // namespace catchlight::app
