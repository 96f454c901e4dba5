#include "app/support/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <mutex>
#include <utility>

namespace catchlight::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kRedrawInterval = std::chrono::milliseconds(100);
constexpr double kLineInterval_s = 10;
constexpr int kBarWidth = 28;
/// Before, frames that wait in queues would tell of rates that there are not.
constexpr double kRateAfter_s = 1;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string rounded(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

}  // namespace

std::string progress_text(const std::string& label, std::int64_t done, std::optional<std::int64_t> total, const std::string& unit,
                          double elapsed_s) {
  std::string text = label + ' ';
  if (total && *total > 0) {
    const auto filled = static_cast<std::size_t>(std::clamp<std::int64_t>(done * kBarWidth / *total, 0, kBarWidth));
    text += '[' + std::string(filled, '#') + std::string(kBarWidth - filled, ' ') + "] ";
  }
  if (unit == "%")
    text += std::to_string(done) + " %";
  else
    text += std::to_string(done) + (total ? '/' + std::to_string(*total) : "") + ' ' + unit;
  if (done <= 0 || elapsed_s < kRateAfter_s) return text;
  const double rate = static_cast<double>(done) / elapsed_s;
  if (unit != "%") text += ", " + rounded(rate, 1) + " /s";
  if (total && *total > done) text += ", " + rounded(static_cast<double>(*total - done) / rate, 0) + " s left";
  return text;
}

Progress::Progress(Log& log, std::string label, std::optional<std::int64_t> total, std::string unit)
    : log_(log),
      label_(std::move(label)),
      unit_(std::move(unit)),
      total_(total),
      on_terminal_(isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      last_drawn_(start_ - kRedrawInterval) {}

Progress::~Progress() {
  const std::lock_guard lock(log_.mutex_);
  if (std::exchange(log_.bar_shown_, false)) std::fputc('\n', stderr);
}

void Progress::update(std::int64_t done, const std::string& state) {
  if (log_.task_handler_ && total_ && *total_ > 0)
    log_.task_handler_(label_, static_cast<double>(done) / static_cast<double>(*total_));
  if (log_.quiet()) return;
  if (done <= 0) start_ = Clock::now();
  std::string text = progress_text(label_, done, total_, unit_, seconds_since(start_));
  if (!state.empty()) text += ", " + state;
  on_terminal_ ? draw_bar(done, text) : print_line(done, text);
}

void Progress::draw_bar(std::int64_t done, const std::string& text) {
  const bool is_last = total_ && done >= *total_;
  if (!is_last && Clock::now() - last_drawn_ < kRedrawInterval) return;
  last_drawn_ = Clock::now();
  const std::lock_guard lock(log_.mutex_);
  std::fprintf(stderr, "\r%s\033[K", text.c_str());
  log_.bar_shown_ = true;
}

void Progress::print_line(std::int64_t done, const std::string& text) {
  if (total_ && *total_ <= 0) return;
  const std::int64_t step = total_ ? done * 10 / *total_ : static_cast<std::int64_t>(seconds_since(start_) / kLineInterval_s);
  if (step <= last_step_) return;
  last_step_ = step;
  log_.info(text);
}

ProgressHandler progress_handler(Log& log, const std::string& label) {
  const auto progress = std::make_shared<Progress>(log, label, 100, "%");
  return [progress](double share) { progress->update(static_cast<std::int64_t>(share * 100)); };
}

}  // namespace catchlight::app
