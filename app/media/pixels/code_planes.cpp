#include "app/media/pixels/color_tags.hpp"
#include "app/media/pixels/frame.hpp"
#include "app/media/pixels/pixel_layout.hpp"
#include "catchlight/color.hpp"
#include "catchlight/frame_image.hpp"

extern "C" {
#include <libavutil/frame.h>
}

namespace catchlight::app {
namespace {

constexpr double kRoundingVariance = 1.0 / 12;

class PlaneReader {
 public:
  PlaneReader(const AVFrame& picture, const PixelLayout& layout)
      : layout_(layout), count_(layout.model == ColorModel::gray ? 1 : 3) {
    const CodeFromRgb code_from_rgb(picture, layout);
    offset_ = code_from_rgb(glm::dvec3(0));
    glm::dmat3 codes_from_rgb;
    for (int i = 0; i < 3; ++i) {
      glm::dvec3 unit(0);
      unit[i] = 1;
      codes_from_rgb[i] = code_from_rgb(unit) - offset_;
    }
    white_ = (code_from_rgb(glm::dvec3(1)) - offset_).x;
    if (count_ == 3) rgb_from_codes_ = glm::inverse(codes_from_rgb);
    for (int i = 0; i < count_; ++i) planes_.emplace_back(picture, layout, i);
  }

  /// RGB of the codes at a pixel, by the one chroma sample of its block.
  glm::dvec3 rgb(int x, int y) const {
    if (count_ == 1) return glm::dvec3((at(0, x, y) - offset_.x) / white_);
    const int sx = layout_.chroma_shift_x, sy = layout_.chroma_shift_y;
    return rgb_from_codes_ * (glm::dvec3(at(0, x, y), at(1, x >> sx, y >> sy), at(2, x >> sx, y >> sy)) - offset_);
  }

  /// What Y holds; of RGB, Rec. 709's luma.
  double luma(int x, int y) const {
    return layout_.model == ColorModel::rgb ? glm::dot(kLuminanceWeights, rgb(x, y)) : (at(0, x, y) - offset_.x) / white_;
  }

  glm::dmat3 rounding() const {
    if (layout_.is_float) return glm::dmat3(0.0);
    if (count_ == 3) return rgb_from_codes_ * glm::transpose(rgb_from_codes_) * kRoundingVariance;
    const glm::dvec3 step(1 / white_);
    return glm::outerProduct(step, step) * kRoundingVariance;
  }

 private:
  double at(int plane, int x, int y) const {
    const auto& samples = planes_[static_cast<std::size_t>(plane)];
    return layout_.is_float ? samples.value(x, y) : samples.code(x, y);
  }

  const PixelLayout& layout_;
  int count_;
  glm::dvec3 offset_;
  double white_;
  glm::dmat3 rgb_from_codes_{1.0};
  std::vector<SamplePlane> planes_;
};

}  // namespace

CodePlanes Frame::code_planes(const PixelRect& rect) const {
  const AVFrame& picture = *picture_;
  const PixelLayout layout = pixel_layout(picture.format).value();
  const PixelRect inside = intersect(rect, {0, 0, picture.width, picture.height});
  const int sx = layout.chroma_shift_x, sy = layout.chroma_shift_y;
  const int left = (inside.x + (1 << sx) - 1) >> sx, top = (inside.y + (1 << sy) - 1) >> sy;
  const int across = ((inside.x + inside.width) >> sx) - left, down = ((inside.y + inside.height) >> sy) - top;
  CodePlanes planes;
  planes.block_shift = {sx, sy};
  if (inside.empty() || across <= 0 || down <= 0) return planes;
  planes.rect = {left << sx, top << sy, across << sx, down << sy};
  const PlaneReader reader(picture, layout);
  planes.rounding = reader.rounding();
  for (int y = planes.rect.y; y < planes.rect.y + planes.rect.height; ++y)
    for (int x = planes.rect.x; x < planes.rect.x + planes.rect.width; ++x)
      planes.luma.push_back(static_cast<float>(reader.luma(x, y)));
  for (int y = 0; y < down; ++y)
    for (int x = 0; x < across; ++x) {
      const int px = (left + x) << sx, py = (top + y) << sy;
      planes.color.push_back(glm::vec3(reader.rgb(px, py) - reader.luma(px, py)));
    }
  return planes;
}

}  // namespace catchlight::app
