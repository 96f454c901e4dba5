// Messages to the user: always stderr, so that stdout stays free for data.
#pragma once

#include <mutex>
#include <string>
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

 private:
  friend class Progress;
  /// With the mutex held.
  void print(const char* label, const char* color, const std::string& message);

  std::mutex mutex_;
  bool quiet_ = false, verbose_ = false;
  bool bar_shown_ = false;  ///< the cursor stands behind a progress bar
  std::vector<std::string> warnings_;
};

}  // namespace catchlight::app
