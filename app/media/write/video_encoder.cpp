#include "app/media/write/video_encoder.hpp"

#include <algorithm>
#include <array>

#include "app/media/pixels/color_tags.hpp"
#include "app/media/pixels/convert.hpp"
#include "catchlight/error.hpp"
#include "catchlight/response.hpp"
#include "catchlight/util/text.hpp"

extern "C" {
#include <libavutil/cpu.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
}

namespace catchlight::app {
namespace {

constexpr AVPixelFormat kH264Formats[] = {
    AV_PIX_FMT_YUV420P,     AV_PIX_FMT_YUV422P,     AV_PIX_FMT_YUV444P, AV_PIX_FMT_NV12,     AV_PIX_FMT_YUV420P10LE,
    AV_PIX_FMT_YUV422P10LE, AV_PIX_FMT_YUV444P10LE, AV_PIX_FMT_GRAY8,   AV_PIX_FMT_GRAY10LE, AV_PIX_FMT_NONE};
// H.264 crops in whole chroma samples: odd sizes need full chroma.
constexpr AVPixelFormat kH264OddFormats[] = {AV_PIX_FMT_YUV444P, AV_PIX_FMT_YUV444P10LE, AV_PIX_FMT_GRAY8, AV_PIX_FMT_GRAY10LE,
                                             AV_PIX_FMT_NONE};
constexpr AVPixelFormat kY4mFormats[] = {
    AV_PIX_FMT_YUV420P,     AV_PIX_FMT_YUV422P,     AV_PIX_FMT_YUV444P,     AV_PIX_FMT_YUV411P,     AV_PIX_FMT_YUV420P10LE,
    AV_PIX_FMT_YUV422P10LE, AV_PIX_FMT_YUV444P10LE, AV_PIX_FMT_YUV420P12LE, AV_PIX_FMT_YUV422P12LE, AV_PIX_FMT_YUV444P12LE,
    AV_PIX_FMT_YUV420P16LE, AV_PIX_FMT_YUV422P16LE, AV_PIX_FMT_YUV444P16LE, AV_PIX_FMT_GRAY8,       AV_PIX_FMT_NONE};

struct CodecTraits {
  const char* name;  // FFmpeg's
  const char* user_name;
  const char* package_hint;
};

CodecTraits traits(VideoCodec codec) {
  switch (codec) {
    case VideoCodec::h264:
      return {"libx264", "H.264", "an FFmpeg with libx264"};
    case VideoCodec::ffv1:
      return {"ffv1", "FFV1", "an FFmpeg with FFV1"};
    case VideoCodec::y4m:
      return {"wrapped_avframe", "y4m", "an FFmpeg with wrapped frames"};
    case VideoCodec::png:
      return {"png", "PNG", "an FFmpeg with PNG"};
  }
  throw std::logic_error("unknown codec");
}

const AVCodec& found_encoder(VideoCodec codec) {
  const AVCodec* found = avcodec_find_encoder_by_name(traits(codec).name);
  if (!found) throw Error("cannot encode: " + std::string(traits(codec).package_hint) + " is needed");
  return *found;
}

const AVPixelFormat* formats_of(VideoCodec codec, int width_px, int height_px) {
  if (codec == VideoCodec::y4m) return kY4mFormats;
  if (codec != VideoCodec::h264) return found_encoder(codec).pix_fmts;
  return width_px % 2 == 0 && height_px % 2 == 0 ? kH264Formats : kH264OddFormats;
}

void copy_tags(AVCodecContext& encoder, const AVFrame& converted) {
  encoder.color_range = converted.color_range;
  encoder.colorspace = converted.colorspace;
  encoder.color_primaries = converted.color_primaries;
  encoder.color_trc = converted.color_trc;
  encoder.chroma_sample_location = converted.chroma_location;
  encoder.sample_aspect_ratio = converted.sample_aspect_ratio;
}

/// x264's macroblock tree reads memory that nobody has written where it runs on AVX-512 and rows are not groups of 8 macroblocks:
/// the same frames gave other bytes in a process that had used the memory before. There it is kept to AVX2, which costs 6 % more.
std::string x264_instructions(int width_px) {
  constexpr int kMacroblock_px = 16, kGroup = 8;
  const bool is_safe = (width_px + kMacroblock_px - 1) / kMacroblock_px % kGroup == 0;
  if (is_safe || (av_get_cpu_flags() & AV_CPU_FLAG_AVX512) == 0) return "";
  return ":asm=MMX2,SSE2Fast,LZCNT,SSSE3,SSE4.2,AVX,FMA3,BMI2,AVX2";
}

void set_quality(VideoCodec codec, const SinkOptions& options, AVRational frame_rate, int width_px, Options& to) {
  if (codec == VideoCodec::h264) {
    to.set("crf", std::to_string(options.crf));
    to.set("preset", options.preset);
    // x264 would take a rate of thousands a second from the time base, and choose a level that players refuse.
    to.set("x264-params",
           "fps=" + std::to_string(frame_rate.num) + "/" + std::to_string(frame_rate.den) + x264_instructions(width_px));
  } else if (codec == VideoCodec::ffv1) {
    to.set("level", "3");
    to.set("slices", "4");
    to.set("slicecrc", "1");
  }
}

}  // namespace

void check_pixel_format(VideoCodec codec, const std::string& name, int width_px, int height_px) {
  const AVPixelFormat asked = av_get_pix_fmt(name.c_str());
  std::vector<std::string> known;
  for (const AVPixelFormat* format = formats_of(codec, width_px, height_px); *format != AV_PIX_FMT_NONE; ++format) {
    if (*format == asked) return;
    known.emplace_back(av_get_pix_fmt_name(*format));
  }
  throw UsageError("--pixel-format " + name + ": " + traits(codec).user_name + " of " + std::to_string(width_px) + "x" +
                   std::to_string(height_px) + " cannot have it; expected " + quoted_list(known));
}

CodecPtr open_encoder(VideoCodec codec, const AVFrame& first, AVRational frame_rate, bool global_header,
                      const SinkOptions& options) {
  const AVCodec& found = found_encoder(codec);
  CodecPtr encoder(allocated(avcodec_alloc_context3(&found)));
  encoder->width = first.width;
  encoder->height = first.height;
  encoder->pix_fmt = options.pixel_format.empty() ? nearest_format(static_cast<AVPixelFormat>(with_display_codes(first)->format),
                                                                   formats_of(codec, first.width, first.height))
                                                  : av_get_pix_fmt(options.pixel_format.c_str());
  encoder->time_base = first.time_base;
  encoder->framerate = frame_rate;
  encoder->thread_count = codec == VideoCodec::png || codec == VideoCodec::y4m ? 1 : 4;
  encoder->flags |= AV_CODEC_FLAG_BITEXACT;
  if (global_header) encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  copy_tags(*encoder, *frame_for(*encoder, first));
  Options settings;
  set_quality(codec, options, frame_rate, first.width, settings);
  check_ffmpeg(avcodec_open2(encoder.get(), &found, settings.get()),
               "cannot encode " + std::to_string(first.width) + "x" + std::to_string(first.height) + " " +
                   av_get_pix_fmt_name(encoder->pix_fmt) + " with " + found.name +
                   (codec == VideoCodec::h264 ? " (preset '" + options.preset + "')" : ""));
  return encoder;
}

FramePtr frame_for(const AVCodecContext& encoder, const AVFrame& picture) {
  FramePtr frame = with_display_codes(picture);
  // y4m does not say its matrix, and readers such as FFmpeg take BT.601 for granted.
  const bool says_no_matrix = encoder.codec_id == AV_CODEC_ID_WRAPPED_AVFRAME;
  if (frame->format != encoder.pix_fmt)
    frame = convert(*frame, encoder.pix_fmt, says_no_matrix ? AVCOL_SPC_SMPTE170M : AVCOL_SPC_BT709);
  frame->pict_type = AV_PICTURE_TYPE_NONE;
  frame->key_frame = 0;
  // PNG readers go by its gamma, and BT.709's bare curve is not how such footage is meant; see TransferFunction.
  const bool rec709 = frame->color_primaries == AVCOL_PRI_BT709 || frame->color_primaries == AVCOL_PRI_UNSPECIFIED;
  if (encoder.codec_id == AV_CODEC_ID_PNG && rec709 && plate_color(picture).transfer == TransferFunction::srgb) {
    frame->color_primaries = AVCOL_PRI_BT709;
    frame->color_trc = AVCOL_TRC_IEC61966_2_1;
  }
  return frame;
}

}  // namespace catchlight::app
