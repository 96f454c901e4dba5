// A word to the user where nothing happens.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "app/support/log.hpp"

namespace catchlight::app {

/// Says "waiting for WHAT" once it has lived for a second.
class Waiting {
 public:
  Waiting(Log& log, std::string what, std::chrono::milliseconds patience = std::chrono::seconds(1));
  ~Waiting();
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable over_;
  bool is_over_ = false;
  std::jthread watching_;
};

}  // namespace catchlight::app
