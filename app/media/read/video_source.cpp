#include "app/media/read/video_source.hpp"

#include <cmath>
#include <utility>

#include "app/media/pixels/convert.hpp"
#include "app/media/pixels/pixel_layout.hpp"
#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"

extern "C" {
#include <libavutil/pixdesc.h>
}

namespace catchlight::app {
namespace {

// What formats without plain samples (palettes, bit-packed, Bayer) become: the nearest of these.
constexpr AVPixelFormat kPlainFormats[] = {AV_PIX_FMT_GRAY8,   AV_PIX_FMT_RGB24,    AV_PIX_FMT_RGBA,    AV_PIX_FMT_GRAY16LE,
                                           AV_PIX_FMT_RGB48LE, AV_PIX_FMT_RGBA64LE, AV_PIX_FMT_YUV420P, AV_PIX_FMT_YUV422P,
                                           AV_PIX_FMT_YUV444P, AV_PIX_FMT_NONE};

// FFmpeg's deprecated second names for full-range YUV.
AVPixelFormat without_j(int format) {
  switch (format) {
    case AV_PIX_FMT_YUVJ420P:
      return AV_PIX_FMT_YUV420P;
    case AV_PIX_FMT_YUVJ422P:
      return AV_PIX_FMT_YUV422P;
    case AV_PIX_FMT_YUVJ444P:
      return AV_PIX_FMT_YUV444P;
    case AV_PIX_FMT_YUVJ440P:
      return AV_PIX_FMT_YUV440P;
    case AV_PIX_FMT_YUVJ411P:
      return AV_PIX_FMT_YUV411P;
    default:
      return static_cast<AVPixelFormat>(format);
  }
}

FramePtr with_plain_samples(FramePtr picture) {
  const AVPixelFormat format = without_j(picture->format);
  if (format != picture->format) {
    picture->format = format;
    picture->color_range = AVCOL_RANGE_JPEG;
  }
  if (pixel_layout(format)) return picture;
  return convert(*picture, nearest_format(format, kPlainFormats));
}

std::int64_t shown_entries(AVStream* stream) {
  std::int64_t shown = 0;
  for (int i = 0; i < avformat_index_get_entries_count(stream); ++i) {
    if ((avformat_index_get_entry(stream, i)->flags & AVINDEX_DISCARD_FRAME) == 0) ++shown;
  }
  return shown;
}

}  // namespace

VideoSource::VideoSource(SourceRequest request) : request_(std::move(request)) {
  open_input();
  choose_stream();
  open_decoder();
  pending_ = next();
  if (!pending_) throw DamagedMedia(about() + " holds no picture");
  complete_info();
}

void VideoSource::open_input() {
  Options options;
  for (const auto& [key, value] : request_.options) options.set(key, value);
  const AVInputFormat* format = request_.input_format.empty() ? nullptr : av_find_input_format(request_.input_format.c_str());
  AVFormatContext* input = allocated(avformat_alloc_context());
  input->interrupt_callback = {[](void* source) { return static_cast<VideoSource*>(source)->is_given_up() ? 1 : 0; }, this};
  const int opened = avformat_open_input(&input, request_.url.c_str(), format, options.get());
  if (opened == AVERROR_INVALIDDATA) {
    throw Error(about() + " is no video that FFmpeg can read, or its header is missing because the file was cut short (" +
                ffmpeg_reason(opened) + ")");
  }
  check_ffmpeg(opened, "cannot open " + about());
  input_.reset(input);
  // FFmpeg shows any text file as a film of a terminal.
  if (std::string(input_->iformat->name) == "tty") throw Error(about() + " is a text file, not a video");
  check_ffmpeg(avformat_find_stream_info(input_.get(), nullptr), "cannot read " + about());
  // A file on a server waits.
  const bool is_file = input_->pb && input_->duration > 0;
  if (is_file) request_.info.is_live = false;
}

void VideoSource::choose_stream() {
  const int best = av_find_best_stream(input_.get(), AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (best < 0 || (input_->streams[best]->disposition & AV_DISPOSITION_ATTACHED_PIC) != 0) {
    throw Error(about() + " holds no video stream (FFmpeg reads it as " + input_->iformat->long_name + ")");
  }
  stream_ = input_->streams[best];
  const bool is_mov = std::string(input_->iformat->name).find("mp4") != std::string::npos;
  if (request_.info.is_sequence || request_.info.is_live || stream_->nb_frames <= 0) return;
  // An MP4's edit list may leave out samples of its table; the index is what remains.
  const int indexed = avformat_index_get_entries_count(stream_);
  expected_packets_ = is_mov && indexed > 0 ? indexed : stream_->nb_frames;
  request_.info.frame_count = is_mov && indexed > 0 ? shown_entries(stream_) : stream_->nb_frames;
}

void VideoSource::open_decoder() {
  const AVCodec* codec = avcodec_find_decoder(stream_->codecpar->codec_id);
  if (!codec)
    throw Error(about() + " is coded as " + avcodec_get_name(stream_->codecpar->codec_id) + ", which this FFmpeg cannot decode");
  decoder_.reset(allocated(avcodec_alloc_context3(codec)));
  check_ffmpeg(avcodec_parameters_to_context(decoder_.get(), stream_->codecpar), "cannot decode " + about());
  decoder_->pkt_timebase = stream_->time_base;
  decoder_->thread_count = 0;
  // Decoders of pictures that stand alone conceal what is missing, or fails its checksum, and say nothing, unless told to be
  // strict.
  const AVCodecDescriptor* properties = avcodec_descriptor_get(codec->id);
  const bool stands_alone = properties && (properties->props & AV_CODEC_PROP_INTRA_ONLY) != 0;
  if (stands_alone && !request_.info.is_live) decoder_->err_recognition |= AV_EF_EXPLODE;
  // Frame threads hold frames back: a camera should not wait for them.
  decoder_->thread_type = request_.info.is_live ? FF_THREAD_SLICE : FF_THREAD_FRAME | FF_THREAD_SLICE;
  check_ffmpeg(avcodec_open2(decoder_.get(), codec, nullptr), "cannot decode " + about());
}

// The video stream's, or the file's.
std::string VideoSource::tag(const char* name) const {
  for (const AVDictionary* tags : {stream_->metadata, input_->metadata})
    if (const AVDictionaryEntry* entry = av_dict_get(tags, name, nullptr, 0)) return entry->value;
  return "";
}

void VideoSource::complete_info() {
  SourceInfo& info = request_.info;
  info.start_timecode = tag("timecode");
  info.title = tag("title");
  info.creation_time = tag("creation_time");
  info.is_interlaced = pending_->picture().interlaced_frame != 0;
  info.codec = avcodec_get_name(stream_->codecpar->codec_id);
  info.pixel_format = av_get_pix_fmt_name(static_cast<AVPixelFormat>(pending_->picture().format));
  const AVRational rate = av_guess_frame_rate(input_.get(), stream_, nullptr);
  const AVRational average = stream_->avg_frame_rate.num > 0 ? stream_->avg_frame_rate : rate;
  info.frame_rate = average.num > 0 && average.den > 0 ? av_q2d(average) : 25;
}

std::optional<Frame> VideoSource::read() {
  if (pending_) return std::exchange(pending_, std::nullopt);
  if (finished_) return {};
  return next();
}

std::optional<Frame> VideoSource::next() {
  FramePtr picture = decode();
  if (!picture) {
    finished_ = true;
    check_complete();
    return {};
  }
  return finish_frame(std::move(picture));
}

FramePtr VideoSource::decode() {
  for (;;) {
    FramePtr picture = make_frame();
    const int received = avcodec_receive_frame(decoder_.get(), picture.get());
    if (received == 0) return picture;
    if (received == AVERROR_EOF) return nullptr;
    if (received == AVERROR(EAGAIN)) {
      feed_decoder();
    } else if (!request_.info.is_live) {
      throw_damaged(ffmpeg_reason(received));  // what the decoder still holds comes after the damage
    }
  }
}

// One packet of the video, or the order to drain.
void VideoSource::feed_decoder() {
  for (;;) {
    const int got = av_read_frame(input_.get(), packet_.get());
    if (got == AVERROR(EAGAIN)) continue;
    if (got == AVERROR_EOF) {
      send(nullptr);
      return;
    }
    if (got < 0) {
      note_damage(ffmpeg_reason(got));
      return;
    }
    const AVStream& stream = *input_->streams[packet_->stream_index];
    if (packet_->pts != AV_NOPTS_VALUE) {
      end_us_ = std::max(end_us_, av_rescale_q(packet_->pts + packet_->duration, stream.time_base, AV_TIME_BASE_Q));
    }
    const bool wanted = packet_->stream_index == stream_->index;
    if (wanted && (packet_->flags & AV_PKT_FLAG_CORRUPT) != 0 && !request_.info.is_live) {
      av_packet_unref(packet_.get());
      note_damage("a part of a frame's data is missing");
      return;
    }
    if (wanted) {
      ++packets_;
      send(packet_.get());
    }
    av_packet_unref(packet_.get());
    if (wanted) return;
  }
}

void VideoSource::send(const AVPacket* packet) {
  const int sent = avcodec_send_packet(decoder_.get(), packet);
  if (sent < 0 && sent != AVERROR_EOF && !request_.info.is_live) throw_damaged(ffmpeg_reason(sent));
}

// The file is damaged, and the decoder has not seen it: it still holds frames from before. They are given out first.
void VideoSource::note_damage(const std::string& reason) {
  damage_ = reason;
  send(nullptr);
}

void VideoSource::throw_damaged(const std::string& reason) {
  finished_ = true;
  const std::string read = request_.info.frame_count
                               ? std::to_string(delivered_) + " of " + counted(*request_.info.frame_count, "frame")
                               : counted(delivered_, "frame");
  throw DamagedMedia(about() + " is damaged or cut short: " + read + " could be read (" + reason + ")");
}

void VideoSource::check_frame(const AVFrame& picture) {
  if (request_.info.is_live) return;
  if (picture.decode_error_flags != 0 || (picture.flags & AV_FRAME_FLAG_CORRUPT) != 0) {
    throw_damaged("the next frame's data is corrupt");
  }
}

// Throws at the end of what could be read, where that was not all that the file announces.
void VideoSource::check_complete() {
  if (!damage_.empty()) throw_damaged(damage_);
  if (request_.info.is_live) return;
  if (request_.info.is_sequence) {
    if (delivered_ < *request_.info.frame_count) throw_damaged("a file is empty or unreadable");
    return;
  }
  if (expected_packets_) {
    if (packets_ < *expected_packets_) throw_damaged("the file ends early");
    return;
  }
  // Containers without a count of frames (Matroska, Flash, ...) announce the duration of their longest stream.
  if (input_->duration_estimation_method != AVFMT_DURATION_FROM_STREAM || input_->duration <= 0) return;
  const std::int64_t start_us = input_->start_time == AV_NOPTS_VALUE ? 0 : input_->start_time;
  const double missing_s = static_cast<double>(start_us + input_->duration - end_us_) / AV_TIME_BASE;
  const double slack_s = 0.1 + 2 / request_.info.frame_rate;  // durations are rounded, and may count one packet more
  if (missing_s > slack_s) throw_damaged("the last " + std::to_string(missing_s) + " s of its announced duration are missing");
}

// Timestamps that are missing or do not rise are made up from the rate.
void VideoSource::complete_times(AVFrame& picture) {
  const AVRational rate = av_guess_frame_rate(input_.get(), stream_, &picture);
  const std::int64_t usual_duration =
      rate.num > 0 ? std::max<std::int64_t>(1, av_rescale_q(1, av_inv_q(rate), stream_->time_base)) : 1;
  std::int64_t pts = picture.best_effort_timestamp;
  if (pts == AV_NOPTS_VALUE) pts = delivered_ == 0 ? 0 : last_pts_ + usual_duration;
  if (delivered_ > 0) pts = std::max(pts, last_pts_ + 1);
  if (delivered_ == 0) first_pts_ = pts;
  picture.pts = last_pts_ = pts;
  picture.time_base = stream_->time_base;
  if (picture.pkt_duration <= 0) picture.pkt_duration = usual_duration;
}

FramePtr VideoSource::turn_upright(FramePtr picture) {
  if (!orientation_) {
    // A picture's own wish (EXIF) goes before the file's.
    const AVFrameSideData* own = av_frame_get_side_data(picture.get(), AV_FRAME_DATA_DISPLAYMATRIX);
    const std::uint8_t* matrix = own ? own->data : av_stream_get_side_data(stream_, AV_PKT_DATA_DISPLAYMATRIX, nullptr);
    try {
      orientation_.emplace(reinterpret_cast<const std::int32_t*>(matrix));
    } catch (const Error& error) {
      throw Error(about() + ": " + error.what());
    }
  }
  av_frame_remove_side_data(picture.get(), AV_FRAME_DATA_DISPLAYMATRIX);
  return orientation_->apply(std::move(picture));
}

void VideoSource::check_shape(const AVFrame& picture) {
  SourceInfo& info = request_.info;
  if (delivered_ == 0) {
    format_ = picture.format;
    info.width_px = picture.width;
    info.height_px = picture.height;
  } else if (format_ != picture.format || picture.width != info.width_px || picture.height != info.height_px) {
    throw_damaged("from there on its pictures have another size or pixel format");
  }
}

Frame VideoSource::finish_frame(FramePtr picture) {
  check_frame(*picture);
  complete_times(*picture);
  if (picture->sample_aspect_ratio.num == 0) {
    picture->sample_aspect_ratio = av_guess_sample_aspect_ratio(input_.get(), stream_, picture.get());
  }
  picture = turn_upright(with_plain_samples(std::move(picture)));
  if (pixel_layout(picture->format)->is_float && picture->color_trc == AVCOL_TRC_UNSPECIFIED)
    picture->color_trc = AVCOL_TRC_LINEAR;
  check_shape(*picture);
  const double time_s = static_cast<double>(picture->pts - first_pts_) * av_q2d(stream_->time_base);
  Frame frame(std::shared_ptr<const AVFrame>(std::move(picture)), request_.info.first_number + delivered_++, time_s,
              request_.response);
  if (request_.hooks.decoded) request_.hooks.decoded(frame);
  return frame;
}

}  // namespace catchlight::app
