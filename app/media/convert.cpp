#include "app/media/convert.hpp"

#include <list>
#include <tuple>

#include "app/media/pixel_layout.hpp"

extern "C" {
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
}

namespace catchlight::app {
namespace {

struct Conversion {
  int width, height, from, to;
  AVColorSpace from_matrix, to_matrix;
  AVColorRange from_range, to_range;
  auto operator<=>(const Conversion&) const = default;
};

ScalerPtr make_scaler(const Conversion& conversion) {
  ScalerPtr scaler(allocated(sws_alloc_context()));
  const auto set = [&](const char* name, int value) { av_opt_set_int(scaler.get(), name, value, 0); };
  set("srcw", conversion.width);
  set("srch", conversion.height);
  set("src_format", conversion.from);
  set("dstw", conversion.width);
  set("dsth", conversion.height);
  set("dst_format", conversion.to);
  set("sws_flags", SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_BICUBIC);
  check_ffmpeg(sws_init_context(scaler.get(), nullptr, nullptr), "cannot convert the pixel format");

  int *inverse_table, *table, from_full, to_full, brightness, contrast, saturation;
  sws_getColorspaceDetails(scaler.get(), &inverse_table, &from_full, &table, &to_full, &brightness, &contrast, &saturation);
  if (conversion.from_range != AVCOL_RANGE_UNSPECIFIED) from_full = conversion.from_range == AVCOL_RANGE_JPEG;
  if (conversion.to_range != AVCOL_RANGE_UNSPECIFIED) to_full = conversion.to_range == AVCOL_RANGE_JPEG;
  sws_setColorspaceDetails(scaler.get(), sws_getCoefficients(conversion.from_matrix), from_full,
                           sws_getCoefficients(conversion.to_matrix), to_full, brightness, contrast, saturation);
  return scaler;
}

// Setting up a scaler costs as much as converting a small part. Recently used ones come first.
SwsContext* cached_scaler(const Conversion& conversion) {
  constexpr std::size_t kKept = 12;
  thread_local std::list<std::pair<Conversion, ScalerPtr>> cache;
  for (auto entry = cache.begin(); entry != cache.end(); ++entry) {
    if (entry->first != conversion) continue;
    cache.splice(cache.begin(), cache, entry);
    return cache.front().second.get();
  }
  cache.emplace_front(conversion, make_scaler(conversion));
  if (cache.size() > kKept) cache.pop_back();
  return cache.front().second.get();
}

bool is_rgb(int format) {
  const AVPixFmtDescriptor* descriptor = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(format));
  // Palettes are not flagged RGB, and swscale reads them as such.
  return (descriptor->flags & (AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL)) != 0 || format == AV_PIX_FMT_MONOWHITE;
}

}  // namespace

FramePtr convert(const AVFrame& picture, AVPixelFormat format) {
  FramePtr result = make_frame_like(picture, format);
  const bool to_rgb = is_rgb(format);
  if (is_rgb(picture.format) && !to_rgb) {
    result->colorspace = AVCOL_SPC_BT709;
    result->color_range = AVCOL_RANGE_MPEG;
  } else if (to_rgb) {
    result->colorspace = AVCOL_SPC_RGB;
    result->color_range = AVCOL_RANGE_JPEG;
  }
  const Conversion conversion{picture.width,       picture.height,
                              picture.format,      format,
                              picture.colorspace,  to_rgb ? picture.colorspace : result->colorspace,
                              picture.color_range, to_rgb ? AVCOL_RANGE_UNSPECIFIED : result->color_range};
  check_ffmpeg(
      sws_scale(cached_scaler(conversion), picture.data, picture.linesize, 0, picture.height, result->data, result->linesize),
      "cannot convert the pixel format");
  return result;
}

void convert_part(const AVFrame& picture, const PixelRect& rect, AVPixelFormat format, std::uint8_t* rows, int stride_bytes) {
  const AVPixFmtDescriptor& format_of_picture = *av_pix_fmt_desc_get(static_cast<AVPixelFormat>(picture.format));
  const std::uint8_t* from[4] = {};
  for (int i = 0; i < format_of_picture.nb_components; ++i) {
    const AVComponentDescriptor& component = format_of_picture.comp[i];
    const bool is_chroma = i == 1 || i == 2;  // in RGB formats the shifts are 0
    const std::ptrdiff_t x = rect.x >> (is_chroma ? format_of_picture.log2_chroma_w : 0);
    const std::ptrdiff_t y = rect.y >> (is_chroma ? format_of_picture.log2_chroma_h : 0);
    from[component.plane] = picture.data[component.plane] + y * picture.linesize[component.plane] + x * component.step;
  }
  std::uint8_t* to[4] = {rows};
  const int to_stride[4] = {stride_bytes};
  const Conversion conversion{rect.width,         rect.height,        picture.format,      format,
                              picture.colorspace, picture.colorspace, picture.color_range, AVCOL_RANGE_UNSPECIFIED};
  check_ffmpeg(sws_scale(cached_scaler(conversion), from, picture.linesize, 0, rect.height, to, to_stride),
               "cannot convert the pixel format");
}

AVPixelFormat nearest_format(AVPixelFormat format, const AVPixelFormat* formats) {
  for (const AVPixelFormat* candidate = formats; *candidate != AV_PIX_FMT_NONE; ++candidate) {
    if (*candidate == format) return format;
  }
  int loss = 0;
  return avcodec_find_best_pix_fmt_of_list(formats, format, 1, &loss);
}

FramePtr with_display_codes(const AVFrame& picture) {
  const auto layout = pixel_layout(picture.format);
  if (!layout || !layout->is_float) return FramePtr(allocated(av_frame_clone(&picture)));
  FramePtr result = make_frame_like(picture, AV_PIX_FMT_RGB48LE);
  const PixelLayout to = pixel_layout(AV_PIX_FMT_RGB48LE).value();
  const bool linear = picture.color_trc == AVCOL_TRC_LINEAR;
  for (int i = 0; i < 3; ++i) {
    const SamplePlane values(picture, *layout, layout->model == ColorModel::gray ? 0 : i), codes(*result, to, i);
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        const double code = linear ? srgb_from_linear(values.value(x, y)) : values.value(x, y);
        codes.set_code(x, y, code > 0 ? static_cast<int>(std::lround(std::min(code, 1.0) * 65535)) : 0);  // not a number: 0
      }
    }
  }
  if (linear) result->color_trc = AVCOL_TRC_IEC61966_2_1;
  result->colorspace = AVCOL_SPC_RGB;
  result->color_range = AVCOL_RANGE_JPEG;
  return result;
}

}  // namespace catchlight::app
