// Footage out: H.264 in MP4/MKV, FFV1, PNG sequences, y4m on stdout.
#pragma once

#include <memory>
#include <string>

#include "app/media/frame_range.hpp"
#include "app/media/pixels/frame.hpp"
#include "app/media/read/source.hpp"

namespace catchlight::app {

struct SinkOptions {
  std::string codec = {};         ///< "h264" or "ffv1"; empty: by the extension
  std::string pixel_format = {};  ///< FFmpeg's name; empty: the footage's, or what its players take
  int crf = 18;
  std::string preset = "medium";
  bool overwrite = false;
  FrameRange frames = {};  ///< those that will be written: what stands in their way is refused before the work
};

/// Writes beside the output's name and renames on finish(); destroyed without finish(), it leaves nothing behind.
class MediaSink {
 public:
  /// By name: `.mp4 .mkv .mov` H.264, `.avi .nut` FFV1 (or as `codec` says), `%04d.png` a sequence numbered like the frames, `-`
  /// or `.y4m` y4m. The first written frame is at time 0; from there timestamps are the source's own (Matroska rounds them to
  /// ms), and so are rate, colour tags, title, creation time, timecode and audio (copied packet by packet for the written time
  /// span; not from cameras, streams and into y4m). Keeps the source's pixel format where the codec has it, else takes the
  /// nearest; but RGB becomes 8-bit 4:2:0 in .mp4, .mov and y4m, which all players take, unless a side is odd. Throws UsageError:
  /// exists without `overwrite`, unknown extension, codec, preset or pixel format, output equal to the input; Error: folder
  /// missing or unwritable, audio that the container cannot hold.
  static std::unique_ptr<MediaSink> open(const std::string& path, const std::string& source_location, const MediaSource& source,
                                         const SinkOptions& options);
  virtual ~MediaSink() = default;

  virtual void write(const Frame& frame) = 0;

  /// Flushes, closes and puts the result under its name. Throws Error when the disk is full: nothing is left under the output's
  /// name.
  virtual void finish() = 0;
};

}  // namespace catchlight::app
