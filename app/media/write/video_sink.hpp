// One file, or stdout, with video and carried-over audio. Private to app/media.
#pragma once

#include <map>
#include <optional>

#include "app/media/write/audio_copy.hpp"
#include "app/media/write/video_encoder.hpp"
#include "app/support/output_file.hpp"

namespace catchlight::app {

struct VideoSinkRequest {
  std::string path;   ///< "-" is stdout
  std::string muxer;  ///< FFmpeg's name
  VideoCodec codec = VideoCodec::h264;
  std::string audio_location;  ///< empty: no audio
  AVRational frame_rate{24, 1};
  SourceInfo source;
  bool fills_gaps = false;  ///< a frame is repeated until the next one's time: for live footage in a file without times
  SinkOptions options;
};

/// The header waits for the first frame, which knows the pixel format and the time that becomes 0.
class VideoSink final : public MediaSink {
 public:
  explicit VideoSink(VideoSinkRequest request);
  void write(const Frame& frame) override;
  void finish() override;

 private:
  void begin(const Frame& first);
  void set_tags(const Frame& first);
  void write_header();
  void encode(const AVFrame* frame);
  void fill_gap(AVFrame& next);
  void close_file();
  std::int64_t source_us(std::int64_t pts) const { return av_rescale_q(pts, encoder_->time_base, AV_TIME_BASE_Q); }
  std::string what() const { return "cannot write '" + request_.path + "'"; }

  VideoSinkRequest request_;
  std::optional<PendingFile> file_;  // none for stdout
  OutputPtr output_;
  AVStream* stream_ = nullptr;
  CodecPtr encoder_;
  std::optional<AudioCopy> audio_;
  PacketPtr packet_ = make_packet();
  std::int64_t start_pts_ = 0, end_pts_ = 0;
  FramePtr last_;                                   ///< where gaps are filled
  std::int64_t ticks_written_ = 0;                  ///< of the frame rate, then
  std::map<std::int64_t, std::int64_t> durations_;  // by pts, of frames inside the encoder
};

}  // namespace catchlight::app
