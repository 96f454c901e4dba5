// Decodes whatever FFmpeg opens. Private to app/media.
#pragma once

#include <atomic>

#include "app/media/ffmpeg_handles.hpp"
#include "app/media/pixels/orientation.hpp"
#include "app/media/read/source.hpp"
#include "catchlight/response.hpp"

namespace catchlight::app {

/// What to hand to avformat_open_input, and what is known beforehand.
struct SourceRequest {
  std::string location;      ///< as the user wrote it; for messages
  std::string url;           ///< as FFmpeg takes it
  std::string input_format;  ///< empty: FFmpeg finds out
  std::vector<std::pair<std::string, std::string>> options;
  SourceInfo info;  ///< frame_count, first_number, is_sequence of a sequence; is_live, is_one_pass
  std::shared_ptr<const CameraResponse> response;
  SourceHooks hooks;
};

class VideoSource final : public MediaSource {
 public:
  explicit VideoSource(SourceRequest request);

  const SourceInfo& info() const override { return request_.info; }
  std::optional<Frame> read() override;
  const AVStream* video_stream() const override { return request_.info.is_sequence ? nullptr : stream_; }

  /// The frame rate that a picture declares of itself, as EXR's may; 0/1 where none does.
  AVRational declared_rate() const { return decoder_->framerate; }
  void stop() override { is_stopped_ = true; }
  bool is_given_up() const { return is_stopped_ || request_.hooks.stop.stop_requested(); }

 private:
  void open_input();
  void choose_stream();
  void open_decoder();
  void complete_info();
  std::string tag(const char* name) const;
  std::optional<Frame> next();
  FramePtr decode();
  void feed_decoder();
  void send(const AVPacket* packet);
  void note_damage(const std::string& reason);
  void check_frame(const AVFrame& picture);
  void complete_times(AVFrame& picture);
  FramePtr turn_upright(FramePtr picture);
  void check_shape(const AVFrame& picture);
  void check_complete();
  Frame finish_frame(FramePtr picture);
  [[noreturn]] void throw_damaged(const std::string& reason);
  std::string about() const { return "'" + request_.location + "'"; }

  SourceRequest request_;
  std::atomic<bool> is_stopped_ = false;
  InputPtr input_;
  AVStream* stream_ = nullptr;
  CodecPtr decoder_;
  PacketPtr packet_ = make_packet();
  std::optional<Orientation> orientation_;
  std::optional<Frame> pending_;  // the first frame, decoded early because it alone knows size and orientation
  std::optional<std::int64_t> expected_packets_;
  std::int64_t packets_ = 0, delivered_ = 0;
  std::int64_t first_pts_ = 0, last_pts_ = 0, end_us_ = 0;
  int format_ = -1;
  bool finished_ = false;
  std::string damage_;  // found while reading ahead; thrown when the frames before it are delivered
};

}  // namespace catchlight::app
