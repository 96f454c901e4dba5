// Footage that comes in and does not wait, or can be read only once: cameras, streams, stdin.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "app/media/read/source.hpp"
#include "app/session/frame_job.hpp"
#include "app/session/recording.hpp"
#include "app/window/playing/take_recorder.hpp"

namespace catchlight::app {

class Session;

/// Thrown where no frames come any more.
struct LostSource {
  std::string why;
};

/// How footage comes in.
struct LiveStatus {
  std::optional<SourceInfo> source;                                    ///< none while it is being opened, or lost
  std::optional<std::chrono::steady_clock::time_point> waiting_since;  ///< for the source, or its next frame
  std::optional<std::string> lost;                                     ///< why no frames come any more
  bool has_ended = false;                                              ///< and will not come again
  std::int64_t dropped_frames = 0;                                     ///< left out for newer ones
  std::optional<TakeStatus> take;                                      ///< the last one
};

/// What the player and the window share of it. May be used from any thread, but for what takes a session: that is the player's.
class LiveFeed {
 public:
  explicit LiveFeed(Recording recording) : recording_(std::move(recording)) {}

  /// The picture stands still: next() gives the last frame again.
  void hold(bool is_held);

  /// Records all that comes in from now on with the scene as it is in `settings`, until the end of the take or of the source.
  /// Throws Error where nothing comes in, and as TakeRecorder.
  void begin_take(const std::string& folder, const SceneSettings& settings);
  void end_take();

  /// A frame has been decoded; it may be left out afterwards.
  void see(const Frame& frame);

  LiveStatus status() const;

  /// Whether there is a next frame to be had, without a wish.
  bool goes_on() const;

  /// Opens the source by `make`. Throws LostSource where that fails.
  SourceInfo open(const std::function<SourceInfo()>& make);

  /// Whether the settings ask for the footage to be read in another way, and it can be.
  bool must_reopen(const Session& session, const SceneSettings& settings) const;

  /// The newest frame, tracked; or the last once more. Throws LostSource where none comes any more.
  FrameJob next(Session& session);

  /// No frames come any more. Whether the source is to be looked for again.
  bool lose(const std::string& why, bool comes_again);

 private:
  const Recording recording_;
  std::optional<FrameJob> last_;  ///< the player thread's
  mutable std::mutex mutex_;      ///< of all that follows
  LiveStatus status_;
  bool is_held_ = false;
  std::unique_ptr<TakeRecorder> take_;
};

}  // namespace catchlight::app
