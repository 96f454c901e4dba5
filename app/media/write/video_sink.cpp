#include "app/media/write/video_sink.hpp"

#include "app/media/write/timecode.hpp"

extern "C" {
#include <libavutil/opt.h>
}

#include "catchlight/error.hpp"

namespace catchlight::app {

VideoSink::VideoSink(VideoSinkRequest request) : request_(std::move(request)) {
  const bool to_stdout = request_.path == "-";
  if (!to_stdout) file_.emplace(pending_output(request_.path, request_.options.overwrite));
  const std::string url = to_stdout ? "pipe:1" : "file:" + file_->pending_path();
  AVFormatContext* output = nullptr;
  check_ffmpeg(avformat_alloc_output_context2(&output, nullptr, request_.muxer.c_str(), url.c_str()), what());
  output_.reset(output);
  output_->flags |= AVFMT_FLAG_BITEXACT;                      // no versions and dates: the same frames give the same bytes
  output_->strict_std_compliance = FF_COMPLIANCE_UNOFFICIAL;  // y4m of more than 8 bits
  // Stream 0 is the video's; its parameters follow with the first frame.
  stream_ = allocated(avformat_new_stream(output, nullptr));
  if (!request_.audio_location.empty()) audio_.emplace(request_.audio_location, *output);
  check_ffmpeg(avio_open(&output_->pb, url.c_str(), AVIO_FLAG_WRITE), what());
}

void VideoSink::begin(const Frame& first) {
  const AVFrame& picture = first.picture();
  encoder_ = open_encoder(request_.codec, picture, request_.frame_rate, (output_->oformat->flags & AVFMT_GLOBALHEADER) != 0,
                          request_.options);
  check_ffmpeg(avcodec_parameters_from_context(stream_->codecpar, encoder_.get()), what());
  stream_->avg_frame_rate = request_.frame_rate;
  stream_->sample_aspect_ratio = picture.sample_aspect_ratio;
  // y4m has no timestamps, only a rate.
  stream_->time_base = request_.codec == VideoCodec::y4m ? av_inv_q(request_.frame_rate) : picture.time_base;
  start_pts_ = picture.pts;
  set_tags(first);
  write_header();
  const bool allows_lead = request_.muxer == "mp4" || request_.muxer == "mov";
  if (audio_) audio_->begin(source_us(start_pts_), allows_lead && first.number() == request_.source.first_number);
}

// The timecode is the first written frame's. Rates that timecodes do not know would make the header fail.
void VideoSink::set_tags(const Frame& first) {
  const auto set = [](AVDictionary** tags, const char* name, const std::string& value) {
    if (!value.empty()) av_dict_set(tags, name, value.c_str(), 0);
  };
  set(&output_->metadata, "title", request_.source.title);
  set(&output_->metadata, "creation_time", request_.source.creation_time);
  set(&stream_->metadata, "timecode", timecode_at(request_.source, first.number()));
}

void VideoSink::write_header() {
  Options options;
  if (request_.muxer == "mp4" || request_.muxer == "mov") {
    options.set("movflags", "+faststart");
    options.set("movie_timescale", "90000");  // places sound that begins after the picture; the default is a coarse 1/1000 s
    options.set("video_track_timescale", std::to_string(stream_->time_base.den));
  }
  check_ffmpeg(avformat_write_header(output_.get(), options.get()), what());
}

void VideoSink::write(const Frame& frame) {
  if (!encoder_) begin(frame);
  const FramePtr picture = frame_for(*encoder_, frame.picture());
  picture->pts -= start_pts_;
  end_pts_ = frame.picture().pts + frame.picture().pkt_duration;
  if (request_.fills_gaps) fill_gap(*picture);
  durations_[picture->pts] = frame.picture().pkt_duration;
  encode(picture.get());
  if (audio_) audio_->copy_until(source_us(frame.picture().pts), *output_);
}

// Gives the frame its place by the frame rate, and the one before all places up to there.
void VideoSink::fill_gap(AVFrame& next) {
  const AVRational tick = av_inv_q(request_.frame_rate);
  const std::int64_t wanted = av_rescale_q(next.pts, encoder_->time_base, tick);
  const auto take_place = [&](AVFrame& frame) { frame.pts = av_rescale_q(ticks_written_++, tick, encoder_->time_base); };
  while (last_ && ticks_written_ < wanted) {
    take_place(*last_);
    encode(last_.get());
  }
  take_place(next);
  last_.reset(allocated(av_frame_clone(&next)));
}

// A null frame drains the encoder.
void VideoSink::encode(const AVFrame* frame) {
  check_ffmpeg(avcodec_send_frame(encoder_.get(), frame), what());
  for (;;) {
    const int received = avcodec_receive_packet(encoder_.get(), packet_.get());
    if (received == AVERROR(EAGAIN) || received == AVERROR_EOF) return;
    check_ffmpeg(received, what());
    if (const auto duration = durations_.find(packet_->pts); duration != durations_.end()) {
      packet_->duration = duration->second;
      durations_.erase(duration);
    }
    av_packet_rescale_ts(packet_.get(), encoder_->time_base, stream_->time_base);
    packet_->stream_index = stream_->index;
    check_ffmpeg(av_interleaved_write_frame(output_.get(), packet_.get()), what());
  }
}

void VideoSink::finish() {
  if (!encoder_) throw Error(what() + ": there is no frame to write");
  encode(nullptr);
  if (audio_) audio_->copy_until(source_us(end_pts_), *output_);
  check_ffmpeg(av_write_trailer(output_.get()), what());
  close_file();
  if (file_) file_->commit();
}

// Buffered bytes reach a full disk only here.
void VideoSink::close_file() {
  avio_flush(output_->pb);
  const int failed = output_->pb->error;
  const int closed = avio_closep(&output_->pb);
  check_ffmpeg(failed, what());
  check_ffmpeg(closed, what());
}

}  // namespace catchlight::app
