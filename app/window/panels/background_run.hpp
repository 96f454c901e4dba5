// A run of this program beside the window.
#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace catchlight::app {

/// Runs `catchlight` with these arguments, and listens to what it says.
class BackgroundRun {
 public:
  explicit BackgroundRun(const std::vector<std::string>& arguments);
  /// Waits for its end.
  ~BackgroundRun() = default;
  BackgroundRun(const BackgroundRun&) = delete;
  BackgroundRun& operator=(const BackgroundRun&) = delete;

  bool is_over() const { return is_over_; }
  /// Whether it ended as it should.
  bool has_succeeded() const { return is_over_ && exit_code_ == 0; }
  /// Its last line.
  std::string last_line() const;

 private:
  void run(const std::string& command);

  mutable std::mutex mutex_;
  std::string line_;
  std::atomic<bool> is_over_ = false;
  std::atomic<int> exit_code_ = -1;
  std::jthread thread_;
};

}  // namespace catchlight::app
