// Footage that does not wait for who reads it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "app/media/read/source.hpp"

namespace catchlight::app {

/// Reads a source on a thread of its own and keeps the newest frame alone, so that who reads slowly sees fewer frames, none of
/// them old. Frames are numbered as they are handed out; their times are the source's.
class NewestFrameSource final : public MediaSource {
 public:
  explicit NewestFrameSource(std::unique_ptr<MediaSource> source);
  ~NewestFrameSource() override;

  const SourceInfo& info() const override { return info_; }
  std::optional<Frame> read() override;
  const AVStream* video_stream() const override { return source_->video_stream(); }
  std::int64_t dropped_frames() const override { return dropped_; }
  void stop() override { source_->stop(); }

 private:
  void read_ahead();

  std::unique_ptr<MediaSource> source_;
  SourceInfo info_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Frame> newest_;
  bool has_ended_ = false;
  std::exception_ptr failure_;
  std::int64_t delivered_ = 0;
  std::atomic<std::int64_t> dropped_ = 0;
  std::jthread reading_;  ///< last, so that it ends before what it uses
};

}  // namespace catchlight::app
