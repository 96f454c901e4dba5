#include "app/media/write/audio_copy.hpp"

#include <algorithm>

#include "catchlight/error.hpp"

namespace catchlight::app {

namespace {

/// Whether the file's header already says so; to look into its packets takes the time of decoding a frame.
bool has_no_audio(const AVFormatContext& input) {
  if ((input.ctx_flags & AVFMTCTX_NOHEADER) != 0) return false;  // streams may appear between the packets
  return std::none_of(input.streams, input.streams + input.nb_streams, [](const AVStream* stream) {
    return stream->codecpar->codec_type == AVMEDIA_TYPE_AUDIO || stream->codecpar->codec_type == AVMEDIA_TYPE_UNKNOWN;
  });
}

}  // namespace

AudioCopy::AudioCopy(const std::string& source_location, AVFormatContext& output) {
  AVFormatContext* input = nullptr;
  check_ffmpeg(avformat_open_input(&input, ("file:" + source_location).c_str(), nullptr, nullptr),
               "cannot read the audio of '" + source_location + "'");
  input_.reset(input);
  if (has_no_audio(*input)) return;
  check_ffmpeg(avformat_find_stream_info(input, nullptr), "cannot read the audio of '" + source_location + "'");
  for (unsigned i = 0; i < input->nb_streams; ++i) {
    const AVCodecParameters& audio = *input->streams[i]->codecpar;
    if (audio.codec_type != AVMEDIA_TYPE_AUDIO) {
      input->streams[i]->discard = AVDISCARD_ALL;
      continue;
    }
    if (avformat_query_codec(output.oformat, audio.codec_id, FF_COMPLIANCE_NORMAL) == 0) {
      throw Error("the audio of '" + source_location + "' is " + avcodec_get_name(audio.codec_id) + ", which " +
                  output.oformat->name + " files cannot hold; write an .mkv instead");
    }
    AVStream* stream = allocated(avformat_new_stream(&output, nullptr));
    check_ffmpeg(avcodec_parameters_copy(stream->codecpar, &audio), "cannot carry the audio over");
    stream->codecpar->codec_tag = 0;  // each container has its own tags
    stream->time_base = input->streams[i]->time_base;
    stream->disposition = input->streams[i]->disposition;
    av_dict_copy(&stream->metadata, input->streams[i]->metadata, 0);
    streams_.push_back({static_cast<int>(i), stream->index});
  }
}

void AudioCopy::begin(std::int64_t start_us, bool with_lead) {
  start_us_ = start_us;
  with_lead_ = with_lead;
}

const AudioCopy::Stream* AudioCopy::stream_of(const AVPacket& packet) const {
  for (const Stream& stream : streams_) {
    if (stream.input_index == packet.stream_index) return &stream;
  }
  return nullptr;
}

// Leaves the next audio packet in packet_. Damage ends the audio: the video's own reader reports it.
bool AudioCopy::read_packet() {
  while (!has_packet_) {
    if (av_read_frame(input_.get(), packet_.get()) < 0) return false;
    has_packet_ = stream_of(*packet_) && packet_->pts != AV_NOPTS_VALUE && (packet_->flags & AV_PKT_FLAG_CORRUPT) == 0;
    if (!has_packet_) av_packet_unref(packet_.get());
  }
  return true;
}

void AudioCopy::copy_until(std::int64_t end_us, AVFormatContext& output) {
  while (!empty() && read_packet()) {
    const Stream& stream = *stream_of(*packet_);
    const AVRational from = input_->streams[stream.input_index]->time_base;
    if (av_compare_ts(packet_->pts, from, end_us, AV_TIME_BASE_Q) >= 0) return;
    has_packet_ = false;
    if (!with_lead_ && av_compare_ts(packet_->pts, from, start_us_, AV_TIME_BASE_Q) < 0) {
      av_packet_unref(packet_.get());
      continue;
    }
    const std::int64_t shift = av_rescale_q(start_us_, AV_TIME_BASE_Q, from);
    packet_->pts -= shift;
    packet_->dts = packet_->dts == AV_NOPTS_VALUE ? packet_->pts : packet_->dts - shift;
    av_packet_rescale_ts(packet_.get(), from, output.streams[stream.output_index]->time_base);
    packet_->stream_index = stream.output_index;
    packet_->pos = -1;
    check_ffmpeg(av_interleaved_write_frame(&output, packet_.get()), "cannot write the audio");
  }
}

}  // namespace catchlight::app
