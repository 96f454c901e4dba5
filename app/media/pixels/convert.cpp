#include "app/media/pixels/convert.hpp"

#include <list>
#include <tuple>

#include "app/media/pixels/color_tags.hpp"
#include "app/media/pixels/pixel_layout.hpp"
#include "catchlight/color.hpp"

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
  // Palettes are not flagged RGB, and swscale reads them as such.
  return (av_pix_fmt_desc_get(static_cast<AVPixelFormat>(format))->flags & (AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL)) != 0;
}

// swscale shifts codes between 16 bits and others where they should be stretched: to it, 16-bit RGB's white is 255 * 256 beside
// limited-range YUV, and the largest code shifted beside full-range YUV.
double white_for_swscale(const AVFrame& yuv) {
  const PixelLayout layout = pixel_layout(yuv.format).value();
  return is_full_range(yuv, layout) ? layout.max_code() << (16 - layout.depth()) : 255 * 256;
}

bool is_deep_rgb(int format) {
  const auto layout = pixel_layout(format);
  return layout && layout->model == ColorModel::rgb && layout->depth() == 16 && !layout->is_float;
}

std::uint16_t multiplied(int code, double factor) {
  return static_cast<std::uint16_t>(std::min(code * factor + 0.5, 65535.0));
}

void multiply_colors(AVFrame& rgb, double factor) {
  const PixelLayout layout = pixel_layout(rgb.format).value();
  for (int i = 0; i < 3; ++i) {
    const SamplePlane plane(rgb, layout, i);
    const Component& component = layout.components[static_cast<std::size_t>(i)];
    for (int y = 0; y < rgb.height; ++y) {
      if (layout.big_endian) {
        for (int x = 0; x < rgb.width; ++x) plane.set_code(x, y, multiplied(plane.code(x, y), factor));
        continue;
      }
      std::uint8_t* row = rgb.data[component.plane] + static_cast<std::ptrdiff_t>(y) * rgb.linesize[component.plane];
      auto* codes = reinterpret_cast<std::uint16_t*>(row + component.offset_bytes);
      const int step = component.step_bytes / 2;
      for (int x = 0; x < rgb.width; ++x) codes[x * step] = multiplied(codes[x * step], factor);
    }
  }
}

void scale(const Conversion& conversion, const std::uint8_t* const from[], const int from_stride[], AVFrame& to) {
  check_ffmpeg(sws_scale(cached_scaler(conversion), from, from_stride, 0, conversion.height, to.data, to.linesize),
               "cannot convert the pixel format");
}

void tag_converted(const AVFrame& from, AVFrame& to, AVColorSpace of_rgb) {
  const auto layout = pixel_layout(to.format);
  if (is_rgb(to.format)) {
    to.colorspace = AVCOL_SPC_RGB;
    to.color_range = AVCOL_RANGE_JPEG;
  } else if (is_rgb(from.format)) {
    to.colorspace = of_rgb;
    to.color_range = layout && layout->model == ColorModel::gray ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
  }
}

}  // namespace

FramePtr convert(const AVFrame& picture, AVPixelFormat format, AVColorSpace of_rgb) {
  FramePtr result = make_frame_like(picture, format);
  tag_converted(picture, *result, of_rgb);
  const bool to_rgb = is_rgb(format);
  const Conversion conversion{picture.width,       picture.height,
                              picture.format,      format,
                              picture.colorspace,  to_rgb ? picture.colorspace : result->colorspace,
                              picture.color_range, to_rgb ? AVCOL_RANGE_UNSPECIFIED : result->color_range};
  if (is_deep_rgb(picture.format) && !to_rgb) {
    const FramePtr darker = make_frame_like(picture, static_cast<AVPixelFormat>(picture.format));
    check_ffmpeg(av_frame_copy(darker.get(), &picture), "cannot copy a frame");
    multiply_colors(*darker, white_for_swscale(*result) / 65535);
    scale(conversion, darker->data, darker->linesize, *result);
    return result;
  }
  scale(conversion, picture.data, picture.linesize, *result);
  if (is_deep_rgb(format) && !is_rgb(picture.format)) multiply_colors(*result, 65535 / white_for_swscale(picture));
  return result;
}

FramePtr convert_part(const AVFrame& picture, const PixelRect& rect, AVPixelFormat rgb_format) {
  const AVPixFmtDescriptor& layout = *av_pix_fmt_desc_get(static_cast<AVPixelFormat>(picture.format));
  const std::uint8_t* from[4] = {};
  for (int i = 0; i < layout.nb_components; ++i) {
    const AVComponentDescriptor& component = layout.comp[i];
    const bool is_chroma = i == 1 || i == 2;  // in RGB formats the shifts are 0
    const std::ptrdiff_t x = rect.x >> (is_chroma ? layout.log2_chroma_w : 0);
    const std::ptrdiff_t y = rect.y >> (is_chroma ? layout.log2_chroma_h : 0);
    from[component.plane] = picture.data[component.plane] + y * picture.linesize[component.plane] + x * component.step;
  }
  FramePtr part = make_frame();
  part->format = rgb_format;
  part->width = rect.width;
  part->height = rect.height;
  check_ffmpeg(av_frame_get_buffer(part.get(), 0), "cannot allocate a frame");
  scale({rect.width, rect.height, picture.format, rgb_format, picture.colorspace, picture.colorspace, picture.color_range,
         AVCOL_RANGE_UNSPECIFIED},
        from, picture.linesize, *part);
  if (is_deep_rgb(rgb_format) && !is_rgb(picture.format)) multiply_colors(*part, 65535 / white_for_swscale(picture));
  return part;
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
