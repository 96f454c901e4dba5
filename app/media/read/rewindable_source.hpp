// Footage that is read again, from its beginning or from any frame.
#pragma once

#include <deque>
#include <functional>

#include "app/media/read/source.hpp"

namespace catchlight::app {

/// The most that a process should keep of decoded frames: 1 GiB, or a quarter of the machine's memory where that is less.
std::int64_t kept_frames_budget();

/// Between keep() and rewind() the frames that are read are kept, as long as they all fit the budget: then they are not decoded
/// again. Otherwise the footage is opened anew.
class RewindableSource final : public MediaSource {
 public:
  using Open = std::function<std::unique_ptr<MediaSource>()>;

  /// `reopen`: opens the same footage.
  RewindableSource(std::unique_ptr<MediaSource> source, Open reopen, std::int64_t budget_bytes = kept_frames_budget());

  const SourceInfo& info() const override { return info_; }
  std::optional<Frame> read() override;
  const AVStream* video_stream() const override { return source_->video_stream(); }
  std::int64_t dropped_frames() const override { return source_->dropped_frames(); }
  void stop() override { source_->stop(); }

  /// `frame_count`: how many frames will be read until rewind(), where that is known. Where they will not fit, none is kept.
  void keep(std::optional<std::int64_t> frame_count);

  /// The next frame is the first that was read after keep(); damage that was met is met again.
  void rewind();

  /// After rewind(): the next frame is the one at that position, from 0; nothing where the footage ends before. Once called, kept
  /// frames stay: a frame may be looked at again and again. Where not all were kept, frames before it are decoded anew.
  void seek(std::int64_t position);

  /// What became of the frames between keep() and rewind().
  struct Kept {
    bool has_all = false;
    std::int64_t bytes = 0;  ///< what was read, or will have been, until it was known not to fit
    std::int64_t budget_bytes = 0;
  };
  const Kept& kept() const { return kept_; }

 private:
  void add(const Frame& frame);
  void let_go();

  std::unique_ptr<MediaSource> source_;
  Open reopen_;
  SourceInfo info_;
  Kept kept_;
  bool is_keeping_ = false;
  std::optional<std::int64_t> frame_count_;
  std::deque<Frame> frames_;
  bool holds_frames_ = false;  ///< they stay when they are read
  std::int64_t position_ = 0;  ///< of the next frame, once frames are sought
  std::optional<std::string> damage_;
};

}  // namespace catchlight::app
