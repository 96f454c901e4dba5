#include "app/media/read/rewindable_source.hpp"

#include <unistd.h>

#include <algorithm>
#include <utility>

extern "C" {
#include <libavutil/frame.h>
}

namespace catchlight::app {
namespace {

std::int64_t bytes_of(const AVFrame& picture) {
  std::int64_t bytes = 0;
  for (const AVBufferRef* buffer : picture.buf)
    if (buffer) bytes += static_cast<std::int64_t>(buffer->size);
  return bytes;
}

}  // namespace

std::int64_t kept_frames_budget() {
  constexpr std::int64_t kMaxBytes = std::int64_t{1} << 30;
  const std::int64_t memory_bytes = std::int64_t{sysconf(_SC_PHYS_PAGES)} * sysconf(_SC_PAGESIZE);
  return std::min(kMaxBytes, memory_bytes / 4);
}

RewindableSource::RewindableSource(std::unique_ptr<MediaSource> source, Open reopen, std::int64_t budget_bytes)
    : source_(std::move(source)), reopen_(std::move(reopen)), info_(source_->info()) {
  kept_.budget_bytes = budget_bytes;
}

void RewindableSource::keep(std::optional<std::int64_t> frame_count) {
  is_keeping_ = kept_.has_all = true;
  frame_count_ = frame_count;
}

void RewindableSource::seek(std::int64_t position) {
  holds_frames_ = true;
  if (kept_.has_all || position == position_) {
    position_ = position;
    return;
  }
  if (position < position_) rewind();
  while (position_ < position && read()) continue;
}

std::optional<Frame> RewindableSource::read() {
  if (holds_frames_ && kept_.has_all) {
    if (position_ < 0 || position_ >= static_cast<std::int64_t>(frames_.size())) return std::nullopt;
    return frames_[static_cast<std::size_t>(position_++)];
  }
  ++position_;
  if (!is_keeping_ && !frames_.empty()) {
    Frame frame = std::move(frames_.front());
    frames_.pop_front();
    return frame;
  }
  if (!is_keeping_ && damage_) throw DamagedMedia(*std::exchange(damage_, std::nullopt));
  try {
    std::optional<Frame> frame = source_->read();
    if (frame && kept_.has_all && is_keeping_) add(*frame);
    return frame;
  } catch (const DamagedMedia& damaged) {
    if (is_keeping_) damage_ = damaged.what();
    throw;
  }
}

void RewindableSource::add(const Frame& frame) {
  const std::int64_t bytes = bytes_of(frame.picture());
  if (frames_.empty() && frame_count_ && *frame_count_ * bytes > kept_.budget_bytes) {
    kept_.bytes = *frame_count_ * bytes;
    return let_go();
  }
  kept_.bytes += bytes;
  if (kept_.bytes > kept_.budget_bytes) return let_go();
  frames_.push_back(frame);
}

void RewindableSource::let_go() {
  kept_.has_all = false;
  frames_.clear();
}

void RewindableSource::rewind() {
  is_keeping_ = false;
  position_ = 0;
  if (kept_.has_all) return;
  damage_.reset();
  source_.reset();  // a decoder holds frames: one at a time
  source_ = reopen_();
}

}  // namespace catchlight::app
