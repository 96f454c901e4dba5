#include "app/media/write/sequence_sink.hpp"

#include <fstream>

#include "catchlight/error.hpp"

namespace catchlight::app {

void SequenceSink::write(const Frame& frame) {
  const std::string path = pattern_.file(frame.number()), what = "cannot write '" + path + "'";
  const PendingFile& file = files_.emplace_back(pending_output(path, options_.overwrite));
  if (!encoder_) encoder_ = open_encoder(VideoCodec::png, frame.picture(), {1, 1}, false, options_);
  const FramePtr picture = frame_for(*encoder_, frame.picture());
  check_ffmpeg(avcodec_send_frame(encoder_.get(), picture.get()), what);
  check_ffmpeg(avcodec_receive_packet(encoder_.get(), packet_.get()), what);
  std::ofstream stream(file.pending_path(), std::ios::binary);
  stream.write(reinterpret_cast<const char*>(packet_->data), packet_->size);
  av_packet_unref(packet_.get());
  stream.close();
  if (!stream) throw Error(what + ": the disk is full or the file cannot be written");
}

void SequenceSink::finish() {
  if (files_.empty()) throw Error("cannot write '" + pattern_.file(0).string() + "' and following: there is no frame to write");
  for (PendingFile& file : files_) file.commit();
}

}  // namespace catchlight::app
