// Which frame of the footage is looked at, and how that goes on.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace catchlight::app {

enum class PlayMode { loop, ping_pong, once };
constexpr auto names_of(PlayMode) {
  return std::array{"loop", "ping-pong", "once"};
}

/// A position in the footage that plays, without a window: what the controls and keys change.
class Playhead {
 public:
  PlayMode mode = PlayMode::loop;

  /// The position stays among the frames, once it is known how many there are.
  void set_frame_count(std::int64_t count) {
    count_ = count;
    if (count > 0) go_to(position_);
  }
  std::int64_t frame_count() const { return count_; }
  std::int64_t position() const { return position_; }
  bool is_playing() const { return is_playing_; }

  void go_to(std::int64_t position);
  void step(std::int64_t frames) { is_playing_ = false, go_to(position_ + frames); }
  void toggle() { is_playing_ = !is_playing_, since_s_ = 0; }

  /// The range that plays; without a mark, all.
  void mark_begin() { begin_ = position_; }
  void mark_end() { end_ = position_ + 1; }
  void clear_marks() { begin_.reset(), end_.reset(); }
  std::int64_t begin() const { return begin_.value_or(0); }
  std::int64_t end() const { return end_.value_or(count_); }

  /// How long it stays at its position; none where nothing plays.
  std::optional<double> until_next_s(double frame_rate) const;

  /// Time goes on. Frames that could not be shown meanwhile are left out.
  void advance(double seconds, double frame_rate);

 private:
  void advance_by(std::int64_t frames);

  std::int64_t count_ = 0, position_ = 0;
  int direction_ = 1;
  bool is_playing_ = false;
  double since_s_ = 0;  ///< since the position's frame began
  std::optional<std::int64_t> begin_, end_;
};

}  // namespace catchlight::app
