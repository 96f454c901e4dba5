// The encoders that a sink may use, set up from the first frame. Private to app/media.
#pragma once

#include <optional>

#include "app/media/ffmpeg_handles.hpp"
#include "app/media/write/sink.hpp"

namespace catchlight::app {

enum class VideoCodec { h264, ffv1, y4m, png };

/// Throws UsageError where the codec has no pixel format of that name, for frames of that size.
void check_pixel_format(VideoCodec codec, const std::string& name, int width_px, int height_px);

/// An encoder for frames like `first`: its size, colour tags, aspect ratio and time base, and the pixel format that is asked for
/// or the nearest to its own that the codec has. Encoders run with a fixed number of threads, since x264's output depends on it.
CodecPtr open_encoder(VideoCodec codec, const AVFrame& first, AVRational frame_rate, bool global_header,
                      const SinkOptions& options);

/// `picture` as the encoder takes it: its pixel format, nothing of the decoder's (picture types) to steer it by.
FramePtr frame_for(const AVCodecContext& encoder, const AVFrame& picture);

}  // namespace catchlight::app
