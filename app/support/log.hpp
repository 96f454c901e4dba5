// Messages to the user: always stderr, so that stdout stays free for data.
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "catchlight/error.hpp"

namespace catchlight::app {

/// Several threads may write at once. Colours only on a terminal and without NO_COLOR (https://no-color.org).
class Log {
 public:
  static constexpr std::size_t kMaxWarnings = 200;

  void set_quiet(bool quiet) { quiet_ = quiet; }
  bool quiet() const { return quiet_; }
  void set_verbose(bool verbose) { verbose_ = verbose; }

  void info(const std::string& message);    ///< not when quiet
  void detail(const std::string& message);  ///< when verbose, and not quiet

  /// Kept for the report also when quiet. What was said before is not said again, and at most kMaxWarnings are kept: a camera may
  /// run for days.
  void warn(const std::string& message);
  void error(const std::string& message);

  /// Valid as long as the log.
  WarningHandler warning_handler() {
    return [this](const std::string& message) { warn(message); };
  }
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// Hears of long tasks, also when quiet: what is done ("track", "bake"), and the share that is. Called on whichever thread does
  /// it; what it throws ends the task.
  using TaskHandler = std::function<void(const std::string& task, double share)>;
  void set_task_handler(TaskHandler handler) { task_handler_ = std::move(handler); }

 private:
  friend class Progress;
  /// With the mutex held.
  void print(const char* label, const char* color, const std::string& message);

  std::mutex mutex_;
  bool quiet_ = false, verbose_ = false;
  bool bar_shown_ = false;  ///< the cursor stands behind a progress bar
  std::vector<std::string> warnings_;
  TaskHandler task_handler_;
};

}  // namespace catchlight::app
