// PNG files numbered like the frames. Private to app/media.
#pragma once

#include <vector>

#include "app/media/read/sequence.hpp"
#include "app/media/write/video_encoder.hpp"
#include "app/support/output_file.hpp"

namespace catchlight::app {

/// 8-bit RGB (or grey, or with alpha) from 8-bit footage, 16-bit from deeper; all files get their names in finish().
class SequenceSink final : public MediaSink {
 public:
  SequenceSink(SequencePattern pattern, const SinkOptions& options) : pattern_(std::move(pattern)), options_(options) {}
  void write(const Frame& frame) override;
  void finish() override;

 private:
  SequencePattern pattern_;
  SinkOptions options_;
  CodecPtr encoder_;
  PacketPtr packet_ = make_packet();
  std::vector<PendingFile> files_;
};

}  // namespace catchlight::app
