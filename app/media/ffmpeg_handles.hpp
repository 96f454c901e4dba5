// Owners for FFmpeg's objects, and its error codes as text. Private to app/media.
#pragma once

#include <memory>
#include <new>
#include <string>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

namespace catchlight::app {

struct FfmpegDelete {
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
  void operator()(AVFormatContext* input) const { avformat_close_input(&input); }
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

struct OutputDelete {
  void operator()(AVFormatContext* output) const {
    if (output->pb) avio_closep(&output->pb);
    avformat_free_context(output);
  }
};

using FramePtr = std::unique_ptr<AVFrame, FfmpegDelete>;
using PacketPtr = std::unique_ptr<AVPacket, FfmpegDelete>;
using CodecPtr = std::unique_ptr<AVCodecContext, FfmpegDelete>;
using InputPtr = std::unique_ptr<AVFormatContext, FfmpegDelete>;
using OutputPtr = std::unique_ptr<AVFormatContext, OutputDelete>;
using ScalerPtr = std::unique_ptr<SwsContext, FfmpegDelete>;

/// Key and value pairs for FFmpeg's open functions; what they did not know is left in it.
class Options {
 public:
  Options() = default;
  Options(const Options&) = delete;
  Options& operator=(const Options&) = delete;
  ~Options() { av_dict_free(&entries_); }
  void set(const std::string& key, const std::string& value) { av_dict_set(&entries_, key.c_str(), value.c_str(), 0); }
  AVDictionary** get() { return &entries_; }

 private:
  AVDictionary* entries_ = nullptr;
};

template <class T>
T* allocated(T* object) {
  if (!object) throw std::bad_alloc();
  return object;
}

inline FramePtr make_frame() {
  return FramePtr(allocated(av_frame_alloc()));
}
inline PacketPtr make_packet() {
  return PacketPtr(allocated(av_packet_alloc()));
}

/// A frame of its own samples (uninitialised), with `like`'s timestamps and colour tags.
FramePtr make_frame_like(const AVFrame& like, AVPixelFormat format);

/// From now on FFmpeg's messages go to ffmpeg_reason() instead of the terminal.
void capture_ffmpeg_log();

/// `code` in words, with the last error lines FFmpeg logged; those are then forgotten.
std::string ffmpeg_reason(int code);

/// Throws Error "`what`: reason" where `code` is an error; else returns it.
int check_ffmpeg(int code, const std::string& what);

}  // namespace catchlight::app
