// How far a long task is, on stderr.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "app/support/log.hpp"
#include "catchlight/progress.hpp"

namespace catchlight::app {

/// Shows a bar that is drawn over itself on a terminal, else a line every tenth of the way, or every ten seconds where nobody
/// knows how long it is; nothing when the log is quiet.
class Progress {
 public:
  /// `total`: frames, where known. Without, the count is shown. `unit`: what is counted, e.g. "frames".
  Progress(Log& log, std::string label, std::optional<std::int64_t> total, std::string unit = "frames");
  ~Progress();  ///< ends the bar's line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// The rate is that of what was done since the last update(0). `state` is shown behind it.
  void update(std::int64_t done, const std::string& state = "");

 private:
  void draw_bar(std::int64_t done, const std::string& text);
  void print_line(std::int64_t done, const std::string& text);

  Log& log_;
  std::string label_, unit_;
  std::optional<std::int64_t> total_;
  bool on_terminal_;
  std::chrono::steady_clock::time_point start_, last_drawn_;
  std::int64_t last_step_ = 0;
};

/// The text of one bar, for `width` columns: "label [####      ] 12/36 frames, 4.2 /s, 6 s left".
std::string progress_text(const std::string& label, std::int64_t done, std::optional<std::int64_t> total, const std::string& unit,
                          double elapsed_s);

/// A share of the whole, 0 to 1, shown as per cent.
ProgressHandler progress_handler(Log& log, const std::string& label);

}  // namespace catchlight::app
