#include "app/media/write/sink.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "app/media/pixels/pixel_layout.hpp"
#include "app/media/write/output_sequence.hpp"
#include "app/media/write/sequence_sink.hpp"
#include "app/media/write/video_sink.hpp"
#include "app/support/output_file.hpp"
#include "catchlight/error.hpp"

extern "C" {
#include <libavutil/pixdesc.h>
}

namespace catchlight::app {
namespace {

namespace fs = std::filesystem;

struct Container {
  std::string_view extension, muxer, codec;  // codec: what it gets where none is asked for
};

constexpr std::array kContainers{Container{".mp4", "mp4", "h264"}, Container{".mkv", "matroska", "h264"},
                                 Container{".mov", "mov", "h264"}, Container{".avi", "avi", "ffv1"},
                                 Container{".nut", "nut", "ffv1"}, Container{".y4m", "yuv4mpegpipe", "y4m"}};

std::string lower_extension(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

const Container& container_of(const std::string& path) {
  const std::string extension = path == "-" ? ".y4m" : lower_extension(path);
  for (const Container& container : kContainers) {
    if (container.extension == extension) return container;
  }
  std::string known;
  for (const Container& container : kContainers) known += std::string(container.extension) + ", ";
  const std::string hint = extension == ".png" ? " (a PNG output is a sequence: its name needs a number field)" : "";
  throw UsageError("'" + path + "': unknown output '" + extension + "'" + hint + "; known are " + known +
                   "sequences of .png or .exr such as 'out.%04d.png', and '-' for y4m on stdout");
}

VideoCodec codec_of(const std::string& path, const Container& container, const std::string& asked) {
  const std::string name = asked.empty() || container.codec == "y4m" ? std::string(container.codec) : asked;
  if (name == "y4m") return VideoCodec::y4m;
  if (name != "h264" && name != "ffv1") throw UsageError("unknown codec '" + name + "'; known are h264 and ffv1");
  const AVCodecID id = name == "h264" ? AV_CODEC_ID_H264 : AV_CODEC_ID_FFV1;
  const AVOutputFormat* muxer = av_guess_format(std::string(container.muxer).c_str(), nullptr, nullptr);
  if (!muxer || avformat_query_codec(muxer, id, FF_COMPLIANCE_NORMAL) == 0) {
    throw UsageError("'" + path + "': " + std::string(container.extension) + " files cannot hold " + name +
                     "; write an .mkv instead");
  }
  return name == "h264" ? VideoCodec::h264 : VideoCodec::ffv1;
}

// x264 itself complains on the terminal.
void check_quality(const SinkOptions& options) {
  constexpr std::array<std::string_view, 10> kPresets{"ultrafast", "superfast", "veryfast", "faster",   "fast",
                                                      "medium",    "slow",      "slower",   "veryslow", "placebo"};
  if (std::find(kPresets.begin(), kPresets.end(), options.preset) == kPresets.end()) {
    std::string known;
    for (const std::string_view preset : kPresets) known.append(known.empty() ? "" : ", ").append(preset);
    throw UsageError("unknown preset '" + options.preset + "'; known are " + known);
  }
  if (options.crf < 0 || options.crf > 51)
    throw UsageError("crf " + std::to_string(options.crf) + " is outside 0 (lossless) to 51");
}

// Rates are quotients of small numbers (30000/1001); a double holds them well enough to find them again.
AVRational frame_rate_of(const MediaSource& source) {
  const AVStream* stream = source.video_stream();
  if (stream && stream->avg_frame_rate.num > 0) return stream->avg_frame_rate;
  return av_d2q(source.info().frame_rate > 0 ? source.info().frame_rate : 25, 1001000);
}

/// The pixel format that is asked for. Without, players of these files decide for RGB, whose nearest format, 4:4:4, many of them
/// refuse; empty where the footage's own may be kept.
std::string pixel_format_for(VideoCodec codec, std::string_view muxer, const SourceInfo& source, const SinkOptions& options) {
  if (!options.pixel_format.empty()) {
    check_pixel_format(codec, options.pixel_format, source.width_px, source.height_px);
    return options.pixel_format;
  }
  const bool is_for_players = codec == VideoCodec::y4m || (codec == VideoCodec::h264 && (muxer == "mp4" || muxer == "mov"));
  const bool is_even = source.width_px % 2 == 0 && source.height_px % 2 == 0;
  const std::optional<PixelLayout> layout = pixel_layout(av_get_pix_fmt(source.pixel_format.c_str()));
  return is_for_players && is_even && layout && layout->model == ColorModel::rgb ? "yuv420p" : "";
}

std::unique_ptr<MediaSink> open_sequence(const std::string& path, SequencePattern pattern, const std::string& source_location,
                                         const MediaSource& source, const SinkOptions& options) {
  if (lower_extension(path) != ".png")
    throw UsageError("'" + path + "': sequences are written as .png, or as .exr, which is layers");
  check_output_sequence(pattern, source_location, source.info(), options);
  pixel_format_for(VideoCodec::png, "", source.info(), options);
  return std::make_unique<SequenceSink>(std::move(pattern), options);
}

}  // namespace

std::unique_ptr<MediaSink> MediaSink::open(const std::string& path, const std::string& source_location, const MediaSource& source,
                                           const SinkOptions& options) {
  capture_ffmpeg_log();
  if (auto pattern = SequencePattern::parse(path))
    return open_sequence(path, std::move(*pattern), source_location, source, options);
  const Container& container = container_of(path);
  VideoSinkRequest request{.path = path,
                           .muxer = std::string(container.muxer),
                           .codec = codec_of(path, container, options.codec),
                           .audio_location = "",
                           .frame_rate = frame_rate_of(source),
                           .source = source.info(),
                           .options = options};
  if (request.codec == VideoCodec::h264) check_quality(options);
  request.options.pixel_format = pixel_format_for(request.codec, request.muxer, source.info(), options);
  if (path != "-") refuse_same_file(path, source_location);
  constexpr double kMaxRate = 240;  // beyond, a stream's rate is its clock's
  request.fills_gaps = source.info().is_live && request.codec == VideoCodec::y4m && av_q2d(request.frame_rate) <= kMaxRate;
  // What cannot be read a second time has its audio read by nobody; y4m has none.
  if (!source.info().is_sequence && !source.info().is_one_pass && request.codec != VideoCodec::y4m)
    request.audio_location = source_location;
  return std::make_unique<VideoSink>(std::move(request));
}

}  // namespace catchlight::app
