#include "app/media/pixels/frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/media/pixels/color_tags.hpp"
#include "app/media/pixels/composite_writer.hpp"
#include "app/media/pixels/convert.hpp"
#include "app/media/pixels/pixel_layout.hpp"
#include "catchlight/color.hpp"
#include "catchlight/error.hpp"
#include "catchlight/response.hpp"

extern "C" {
#include <libavutil/pixdesc.h>
}

namespace catchlight::app {
namespace {

PixelLayout layout_of(const AVFrame& picture) {
  if (const auto layout = pixel_layout(picture.format)) return *layout;
  const char* name = av_get_pix_fmt_name(static_cast<AVPixelFormat>(picture.format));
  throw Error("a frame in pixel format " + std::string(name ? name : "none") + " has to be converted before use");
}

// Contexts are kept by size, so sizes are few: multiples of kGrid. kMargin covers the interpolation of chroma (bicubic: 2 samples
// of 4 pixels).
PixelRect padded(const PixelRect& rect, const PixelLayout& layout, int width_px, int height_px) {
  constexpr int kGrid = 64, kMargin = 16;
  // Where the last chroma sample covers fewer pixels, swscale spreads the samples over the frame at another pitch: no part equals
  // the whole.
  const int mask_x = (1 << layout.chroma_shift_x) - 1, mask_y = (1 << layout.chroma_shift_y) - 1;
  if ((width_px & mask_x) != 0 || (height_px & mask_y) != 0) return {0, 0, width_px, height_px};
  const int x = std::max(0, rect.x - kMargin) & ~(kGrid - 1), y = std::max(0, rect.y - kMargin) & ~(kGrid - 1);
  const int right = (rect.x + rect.width + kMargin + kGrid - 1) & ~(kGrid - 1);
  const int bottom = (rect.y + rect.height + kMargin + kGrid - 1) & ~(kGrid - 1);
  return intersect({x, y, right - x, bottom - y}, {0, 0, width_px, height_px});
}

template <class Code>
inline void interleave(const std::array<const Code*, 3>& from, int width, Code* packed) {
  const Code *red = from[0], *green = from[1], *blue = from[2];
  for (int i = 0; i < width; ++i) {
    packed[3 * i] = red[i];
    packed[3 * i + 1] = green[i];
    packed[3 * i + 2] = blue[i];
  }
}

[[gnu::target_clones("avx2", "default")]] void pack(const std::array<const std::uint8_t*, 3>& from, int width,
                                                    std::uint8_t* packed) {
  interleave(from, width, packed);
}

void pack(const std::array<const std::uint16_t*, 3>& from, int width, std::uint16_t* packed) {
  interleave(from, width, packed);
}

/// Packs planes of green, blue and red, as FFmpeg orders them.
template <class Code>
void pack_row(const AVFrame& planes, int x, int y, int width, std::byte* to) {
  constexpr std::array kPlaneOfChannel = {2, 0, 1};
  std::array<const Code*, 3> from;
  for (std::size_t i = 0; i < 3; ++i) {
    const int plane = kPlaneOfChannel[i];
    from[i] = reinterpret_cast<const Code*>(planes.data[plane] + static_cast<std::ptrdiff_t>(y) * planes.linesize[plane]) + x;
  }
  pack(from, width, reinterpret_cast<Code*>(to));
}

AVPixelFormat rgb_format(bool deep, bool in_planes) {
  if (in_planes) return deep ? AV_PIX_FMT_GBRP16 : AV_PIX_FMT_GBRP;
  return deep ? AV_PIX_FMT_RGB48 : AV_PIX_FMT_RGB24;
}

Plate integer_plate(const AVFrame& picture, const PixelLayout& layout, const PixelRect& rect) {
  const bool deep = layout.depth() > 8;
  // swscale makes planes of RGB out of YUV three times as fast as packed RGB, and the same codes.
  const bool in_planes = layout.model == ColorModel::yuv;
  const PixelRect part = padded(rect, layout, picture.width, picture.height);
  const FramePtr rgb = convert_part(picture, part, rgb_format(deep, in_planes));

  Plate plate{rect, deep ? Plate::Format::rgb_u16 : Plate::Format::rgb_u8, {}};
  const int pixel_bytes = deep ? 6 : 3, left = rect.x - part.x;
  const std::size_t row_bytes = static_cast<std::size_t>(rect.width) * static_cast<std::size_t>(pixel_bytes);
  plate.pixels.resize(row_bytes * static_cast<std::size_t>(rect.height));
  for (int y = 0; y < rect.height; ++y) {
    const int row = rect.y - part.y + y;
    std::byte* to = plate.pixels.data() + static_cast<std::size_t>(y) * row_bytes;
    if (in_planes)
      (deep ? pack_row<std::uint16_t> : pack_row<std::uint8_t>)(*rgb, left, row, rect.width, to);
    else
      std::memcpy(to, rgb->data[0] + static_cast<std::ptrdiff_t>(row) * rgb->linesize[0] + left * pixel_bytes, row_bytes);
  }
  return plate;
}

Plate float_plate(const AVFrame& picture, const PixelLayout& layout, const PixelRect& rect) {
  Plate plate{rect, Plate::Format::rgb_f32, {}};
  const auto pixels = static_cast<std::size_t>(rect.width) * static_cast<std::size_t>(rect.height);
  plate.pixels.resize(pixels * 3 * sizeof(float));
  for (int i = 0; i < 3; ++i) {
    const SamplePlane plane(picture, layout, layout.model == ColorModel::gray ? 0 : i);
    std::byte* to = plate.pixels.data() + static_cast<std::size_t>(i) * sizeof(float);
    for (int y = 0; y < rect.height; ++y) {
      for (int x = 0; x < rect.width; ++x, to += 3 * sizeof(float)) {
        const float value = plane.value(rect.x + x, rect.y + y);
        std::memcpy(to, &value, sizeof value);
      }
    }
  }
  return plate;
}

bool has_plain_luma(const PixelLayout& layout) {
  const Component& luma = layout.components[0];
  return layout.model != ColorModel::rgb && luma.depth == 8 && luma.shift == 0 && luma.step_bytes == 1 && luma.offset_bytes == 0;
}

// 8-bit luma of one pixel of a frame that has no such plane; see Frame::luma().
class LumaMaker {
 public:
  LumaMaker(const AVFrame& picture, const PixelLayout& layout, bool is_linear)
      : layout_(layout),
        first_(picture, layout, 0),
        second_(picture, layout, layout.model == ColorModel::rgb ? 1 : 0),
        third_(picture, layout, layout.model == ColorModel::rgb ? 2 : 0),
        linear_(is_linear),
        // Limited-range codes of any depth are the 8-bit ones, shifted; full-range codes fill their depth.
        scale_(is_full_range(picture, layout) ? 255.0 / layout.max_code() : 1.0 / (1 << (layout.depth() - 8))) {}

  std::uint8_t operator()(int x, int y) const {
    const double code = layout_.is_float ? 255 * float_code(x, y) : scale_ * integer_code(x, y);
    return code > 0 ? static_cast<std::uint8_t>(std::min(code, 255.0) + 0.5) : std::uint8_t{0};
  }

 private:
  double integer_code(int x, int y) const {
    if (layout_.model != ColorModel::rgb) return first_.code(x, y);
    return glm::dot(kLuminanceWeights, glm::dvec3(first_.code(x, y), second_.code(x, y), third_.code(x, y)));
  }
  double float_code(int x, int y) const {
    glm::dvec3 rgb(first_.value(x, y), second_.value(x, y), third_.value(x, y));
    if (linear_) rgb = {srgb_from_linear(rgb.r), srgb_from_linear(rgb.g), srgb_from_linear(rgb.b)};
    return layout_.model == ColorModel::rgb ? glm::dot(kLuminanceWeights, rgb) : rgb.r;
  }

  const PixelLayout& layout_;
  SamplePlane first_, second_, third_;
  bool linear_;
  double scale_;
};

/// Luma codes of a curve as sRGB's, so that tracking finds edges in the middle of light. Scaled where the curve goes beyond
/// white, and cut at twice white, where a tag is too bright to be tracked well anyway. Luma is nearest to green.
void recode(std::vector<std::uint8_t>& luma, const ResponseCurve& curve, const LumaView& coded) {
  constexpr int kGreen = 1;
  const double scale = std::clamp(curve.linear_from_code(1, kGreen), 1.0, 2.0);
  std::array<std::uint8_t, 256> table;
  for (int code = 0; code < 256; ++code) {
    const double light =
        curve.linear_from_code((code - coded.black_code) / (coded.white_code - coded.black_code), kGreen) / scale;
    table[static_cast<std::size_t>(code)] =
        static_cast<std::uint8_t>(std::lround(255 * srgb_from_linear(std::clamp(light, 0.0, 1.0))));
  }
  for (std::uint8_t& code : luma) code = table[code];
}

}  // namespace

Frame::Frame(std::shared_ptr<const AVFrame> picture, std::int64_t number, double time_s,
             std::shared_ptr<const CameraResponse> response)
    : picture_(std::move(picture)), number_(number), time_s_(time_s), response_(std::move(response)) {
  layout_of(*picture_);
}

Frame Frame::numbered(std::int64_t number) const {
  Frame frame = *this;
  frame.number_ = number;
  return frame;
}

int Frame::width_px() const {
  return picture_->width;
}
int Frame::height_px() const {
  return picture_->height;
}

bool Frame::is_float() const {
  return layout_of(*picture_).is_float;
}

LumaView Frame::luma() const {
  const PixelLayout layout = layout_of(*picture_);
  LumaView view;
  view.width_px = width_px();
  view.height_px = height_px();
  if (!is_full_range(*picture_, layout)) {
    view.black_code = 16;
    view.white_code = 235;
  }
  const PlateColor color = this->color();
  const bool is_linear = color.transfer == TransferFunction::linear && !color.curve;
  view.transfer = color.transfer;
  if (layout.is_float && view.transfer == TransferFunction::linear) view.transfer = TransferFunction::srgb;
  const bool has_plane = has_plain_luma(layout);
  if (has_plane) {
    view.data = picture_->data[layout.components[0].plane];
    view.stride = picture_->linesize[layout.components[0].plane];
    if (!color.curve) return view;
  }
  if (!made_luma_ && has_plane) {
    made_luma_ = std::make_shared<std::vector<std::uint8_t>>();
    for (int y = 0; y < height_px(); ++y)
      made_luma_->insert(made_luma_->end(), view.data + y * view.stride, view.data + y * view.stride + width_px());
    recode(*made_luma_, *color.curve, view);
  } else if (!made_luma_) {
    const LumaMaker luma_at(*picture_, layout, is_linear);
    made_luma_ = std::make_shared<std::vector<std::uint8_t>>();
    made_luma_->reserve(static_cast<std::size_t>(width_px()) * static_cast<std::size_t>(height_px()));
    for (int y = 0; y < height_px(); ++y) {
      for (int x = 0; x < width_px(); ++x) made_luma_->push_back(luma_at(x, y));
    }
    if (color.curve) recode(*made_luma_, *color.curve, view);
  }
  if (color.curve) view.black_code = 0, view.white_code = 255, view.transfer = TransferFunction::srgb;
  view.data = made_luma_->data();
  view.stride = width_px();
  return view;
}

Plate Frame::rgb(const PixelRect& rect) const {
  const PixelRect inside = intersect(rect, {0, 0, width_px(), height_px()});
  const PixelLayout layout = layout_of(*picture_);
  if (layout.is_float) return float_plate(*picture_, layout, inside);
  if (inside.empty()) return {inside, Plate::Format::rgb_u8, {}};
  return integer_plate(*picture_, layout, inside);
}

PlateColor Frame::color() const {
  PlateColor color = plate_color(*picture_);
  if (response_) color.transfer = response_->transfer, color.curve = response_->curve;
  return color;
}

glm::ivec2 Frame::color_block_shift() const {
  const PixelLayout layout = layout_of(*picture_);
  return {layout.chroma_shift_x, layout.chroma_shift_y};
}

Frame Frame::with_composite(const Composite& composite) const {
  if (intersect(composite.rect, {0, 0, width_px(), height_px()}).empty()) return *this;
  FrameWriter writer(*this);
  writer.write(composite);
  return std::move(writer).finish();
}

Frame Frame::renumbered(std::int64_t number) const {
  Frame frame = *this;
  frame.number_ = number;
  return frame;
}

FrameWriter::FrameWriter(Frame frame) : frame_(std::move(frame)) {
  const AVFrame& picture = *frame_.picture_;
  written_ = make_frame_like(picture, static_cast<AVPixelFormat>(picture.format));
  check_ffmpeg(av_frame_copy(written_.get(), &picture), "cannot copy a frame");
}

void FrameWriter::write(const Composite& composite) const {
  write_composite(*written_, layout_of(*frame_.picture_), composite, [this](const PixelRect& part) { return frame_.rgb(part); });
}

Frame FrameWriter::finish() && {
  frame_.picture_ = std::move(written_);
  frame_.made_luma_.reset();
  return std::move(frame_);
}

}  // namespace catchlight::app
