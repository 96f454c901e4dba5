// Live footage as a recording folder, to be played again.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "app/media/pixels/frame.hpp"
#include "app/media/read/source.hpp"
#include "app/session/recording.hpp"
#include "catchlight/util/bounded_queue.hpp"

namespace catchlight::app {

/// How far a take is.
struct TakeStatus {
  std::string folder;
  std::int64_t written = 0;   ///< frames
  std::int64_t left_out = 0;  ///< frames that came faster than they could be written
  bool is_over = false;
  std::optional<std::string> error;  ///< why there is no footage, once it is over
};

/// Writes footage (video.mkv, without loss where it has 8 bits), camera and scene on a thread of its own.
class TakeRecorder {
 public:
  /// `live`: what is recorded, with the scene as it is now. Throws Error where the folder exists or cannot be made.
  TakeRecorder(std::string folder, Recording live, SourceInfo footage);
  /// Finishes the take.
  ~TakeRecorder() { stop(); }
  TakeRecorder(const TakeRecorder&) = delete;
  TakeRecorder& operator=(const TakeRecorder&) = delete;

  /// Takes a frame from any thread; never waits.
  void add(const Frame& frame);

  /// No more frames are taken; those that were are written.
  void stop();

  TakeStatus status() const;

 private:
  void run();
  void write_footage();
  void write_camera() const;
  void write_scene() const;

  const std::string folder_;  ///< goes again where no frame comes
  const Recording live_;
  const SourceInfo footage_;
  BoundedQueue<Frame> waiting_;
  std::atomic<std::int64_t> written_ = 0, left_out_ = 0;
  std::atomic<bool> is_stopped_ = false;
  mutable std::mutex mutex_;  ///< of the next two
  bool is_over_ = false;
  std::optional<std::string> error_;
  std::jthread thread_;  ///< last, so that it ends before what it uses
};

}  // namespace catchlight::app
