#include "app/support/waiting.hpp"

#include <utility>

namespace catchlight::app {

Waiting::Waiting(Log& log, std::string what, std::chrono::milliseconds patience)
    : watching_([this, &log, what = std::move(what), patience] {
        std::unique_lock lock(mutex_);
        if (!over_.wait_for(lock, patience, [&] { return is_over_; })) log.info("waiting for " + what);
      }) {}

Waiting::~Waiting() {
  const std::lock_guard lock(mutex_);
  is_over_ = true;
  over_.notify_all();
}

}  // namespace catchlight::app
