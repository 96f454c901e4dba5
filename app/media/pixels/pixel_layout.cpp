#include "app/media/pixels/pixel_layout.hpp"

#include <algorithm>

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/pixdesc.h>
}

namespace catchlight::app {
namespace {

bool has_whole_bytes(const AVPixFmtDescriptor& format) {
  constexpr std::uint64_t kOpaque =
      AV_PIX_FMT_FLAG_BITSTREAM | AV_PIX_FMT_FLAG_PAL | AV_PIX_FMT_FLAG_HWACCEL | AV_PIX_FMT_FLAG_BAYER;
  if ((format.flags & kOpaque) != 0 || format.nb_components == 0) return false;
  const bool is_float = (format.flags & AV_PIX_FMT_FLAG_FLOAT) != 0;
  return std::all_of(format.comp, format.comp + format.nb_components, [&](const AVComponentDescriptor& component) {
    if (is_float) return component.depth == 32 && (format.flags & AV_PIX_FMT_FLAG_BE) == 0;
    return component.depth >= 8 && component.depth + component.shift <= 16;
  });
}

ColorModel color_model(const AVPixFmtDescriptor& format) {
  if (format.nb_components < 3) return ColorModel::gray;
  return (format.flags & AV_PIX_FMT_FLAG_RGB) != 0 ? ColorModel::rgb : ColorModel::yuv;
}

int rounded(float code, float max_code) {
  return static_cast<int>(std::min(std::max(code, 0.0f), max_code) + 0.5f);
}

[[gnu::target_clones("avx2", "default")]] void set_bytes(const float* codes, const std::uint8_t* changed, int count,
                                                         std::uint8_t* to) {
  for (int i = 0; i < count; ++i) {
    const auto code = static_cast<std::uint8_t>(rounded(codes[i], 255));
    to[i] = changed[i] != 0 ? code : to[i];
  }
}

}  // namespace

std::optional<PixelLayout> pixel_layout(int format) {
  const AVPixFmtDescriptor* descriptor = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(format));
  // XYZ is no colour model the rest knows, though its samples are plain.
  if (!descriptor || !has_whole_bytes(*descriptor) || format == AV_PIX_FMT_XYZ12LE || format == AV_PIX_FMT_XYZ12BE) return {};
  PixelLayout layout;
  layout.model = color_model(*descriptor);
  layout.is_float = (descriptor->flags & AV_PIX_FMT_FLAG_FLOAT) != 0;
  layout.big_endian = (descriptor->flags & AV_PIX_FMT_FLAG_BE) != 0;
  layout.chroma_shift_x = descriptor->log2_chroma_w;
  layout.chroma_shift_y = descriptor->log2_chroma_h;
  for (int i = 0; i < std::min<int>(descriptor->nb_components, 3); ++i) {
    const AVComponentDescriptor& from = descriptor->comp[i];
    layout.components[static_cast<std::size_t>(i)] = {from.plane, from.step, from.offset, from.shift, from.depth};
  }
  return layout;
}

SamplePlane::SamplePlane(const AVFrame& frame, const PixelLayout& layout, int component)
    : component_(layout.components[static_cast<std::size_t>(component)]),
      mask_((1u << std::min(component_.depth, 16)) - 1u),
      wide_(component_.depth + component_.shift > 8),
      big_endian_(layout.big_endian) {
  data_ = frame.data[component_.plane] + component_.offset_bytes;
  stride_bytes_ = frame.linesize[component_.plane];
}

void SamplePlane::set_code(int x, int y, int value) const {
  std::uint8_t* at = address(x, y);
  const unsigned bits = static_cast<unsigned>(value) << component_.shift;
  if (!wide_) {
    *at = static_cast<std::uint8_t>((*at & ~(mask_ << component_.shift)) | bits);
    return;
  }
  const unsigned merged = (wide_code(at) & ~(mask_ << component_.shift)) | bits;
  at[big_endian_ ? 0 : 1] = static_cast<std::uint8_t>(merged >> 8);
  at[big_endian_ ? 1 : 0] = static_cast<std::uint8_t>(merged);
}

void SamplePlane::set_codes(int x, int y, const float* codes, const std::uint8_t* changed, int count) const {
  if (!wide_ && component_.step_bytes == 1 && component_.depth == 8) return set_bytes(codes, changed, count, address(x, y));
  for (int i = 0; i < count; ++i)
    if (changed[i]) set_code(x + i, y, rounded(codes[i], static_cast<float>(mask_)));
}

}  // namespace catchlight::app
