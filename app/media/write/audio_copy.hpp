// Carries the audio of a file over to another, packet by packet. Private to app/media.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/media/ffmpeg_handles.hpp"

namespace catchlight::app {

/// Reads the source a second time, for its audio streams only.
class AudioCopy {
 public:
  /// Adds the streams to `output`, whose header is not written yet. Throws Error where its container cannot hold one of them.
  AudioCopy(const std::string& source_location, AVFormatContext& output);

  bool empty() const { return streams_.empty(); }

  /// What is written begins at `start_us` of the source's clock (that becomes 0). `with_lead`: keep also what precedes it, such
  /// as the encoder delay that AAC begins with; for the source's own start, in containers that allow times below 0.
  void begin(std::int64_t start_us, bool with_lead);

  /// Hands on all packets that begin before `end_us` of the source's clock.
  void copy_until(std::int64_t end_us, AVFormatContext& output);

 private:
  struct Stream {
    int input_index = 0, output_index = 0;
  };
  bool read_packet();
  const Stream* stream_of(const AVPacket& packet) const;

  InputPtr input_;
  std::vector<Stream> streams_;
  PacketPtr packet_ = make_packet();
  bool has_packet_ = false, with_lead_ = false;
  std::int64_t start_us_ = 0;
};

}  // namespace catchlight::app
