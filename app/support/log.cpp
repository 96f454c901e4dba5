#include "app/support/log.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace catchlight::app {
namespace {

constexpr const char* kNoColor = "";
constexpr const char* kYellow = "\033[33m";
constexpr const char* kRed = "\033[31m";

bool use_color() {
  const char* no_color = std::getenv("NO_COLOR");
  return isatty(STDERR_FILENO) && !(no_color && *no_color);
}

}  // namespace

void Log::info(const std::string& message) {
  const std::lock_guard lock(mutex_);
  if (!quiet_) print("", kNoColor, message);
}

void Log::detail(const std::string& message) {
  if (verbose_) info(message);
}

void Log::warn(const std::string& message) {
  const std::lock_guard lock(mutex_);
  if (warnings_.size() > kMaxWarnings || std::ranges::find(warnings_, message) != warnings_.end()) return;
  warnings_.push_back(warnings_.size() < kMaxWarnings ? message : "there are more warnings than are shown");
  if (!quiet_) print("catchlight: warning: ", kYellow, warnings_.back());
}

void Log::error(const std::string& message) {
  const std::lock_guard lock(mutex_);
  print("catchlight: error: ", kRed, message);
}

void Log::print(const char* label, const char* color, const std::string& message) {
  if (std::exchange(bar_shown_, false)) std::fputc('\n', stderr);
  const bool colored = *color && use_color();
  std::fprintf(stderr, "%s%s%s%s\n", colored ? color : "", label, colored ? "\033[0m" : "", message.c_str());
}

}  // namespace catchlight::app
