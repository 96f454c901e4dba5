#include "app/window/playing/playhead.hpp"

#include <algorithm>
#include <cmath>

namespace catchlight::app {

void Playhead::go_to(std::int64_t position) {
  position_ = std::clamp(position, std::int64_t{0}, std::max(count_ - 1, std::int64_t{0}));
}

void Playhead::advance(double seconds, double frame_rate) {
  if (!is_playing_ || count_ == 0 || !(frame_rate > 0)) return;
  since_s_ += seconds;
  const double frames = std::floor(since_s_ * frame_rate);
  if (frames < 1) return;
  since_s_ -= frames / frame_rate;
  advance_by(static_cast<std::int64_t>(std::min(frames, 1e6)));
}

std::optional<double> Playhead::until_next_s(double frame_rate) const {
  if (!is_playing_ || count_ == 0 || !(frame_rate > 0)) return {};
  return std::max(1 / frame_rate - since_s_, 0.0);
}

void Playhead::advance_by(std::int64_t frames) {
  const std::int64_t first = std::min(begin(), count_ - 1), last = std::max(std::min(end(), count_) - 1, first);
  const std::int64_t length = last - first + 1;
  const std::int64_t offset = std::clamp(position_, first, last) - first;
  switch (mode) {
    case PlayMode::loop:
      return go_to(first + (offset + frames) % length);
    case PlayMode::once:
      if (offset + frames >= length) is_playing_ = false;
      return go_to(std::min(first + offset + frames, last));
    case PlayMode::ping_pong:
      const std::int64_t period = std::max(2 * (length - 1), std::int64_t{1});
      const std::int64_t phase = ((direction_ > 0 ? offset : period - offset) + frames) % period;
      direction_ = phase < length - 1 ? 1 : -1;
      return go_to(first + (phase < length ? phase : period - phase));
  }
}

}  // namespace catchlight::app
