#include "app/media/read/newest_frame_source.hpp"

#include <utility>

namespace catchlight::app {

NewestFrameSource::NewestFrameSource(std::unique_ptr<MediaSource> source)
    : source_(std::move(source)), info_(source_->info()), reading_([this] { read_ahead(); }) {}

NewestFrameSource::~NewestFrameSource() {
  source_->stop();
}

void NewestFrameSource::read_ahead() {
  std::exception_ptr failure;
  try {
    while (std::optional<Frame> frame = source_->read()) {
      const std::lock_guard lock(mutex_);
      // Nobody misses what came before the first frame was asked for: then the scene is still being made.
      if (newest_ && delivered_ > 0) ++dropped_;
      newest_ = std::move(frame);
      changed_.notify_all();
    }
  } catch (...) {
    failure = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  has_ended_ = true;
  failure_ = failure;
  changed_.notify_all();
}

std::optional<Frame> NewestFrameSource::read() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return newest_ || has_ended_; });
  if (newest_) return std::exchange(newest_, std::nullopt)->renumbered(info_.first_number + delivered_++);
  if (const std::exception_ptr failure = std::exchange(failure_, nullptr)) std::rethrow_exception(failure);
  return std::nullopt;
}

}  // namespace catchlight::app
