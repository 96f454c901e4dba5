// Times the named passes of a frame.
#pragma once

#include <chrono>
#include <vector>

#include "render/pass_time.hpp"

namespace catchlight::render {

class PassStopwatch {
 public:
  void begin_frame() { times_.clear(); }

  template <typename Work>
  void pass(const char* name, const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    times_.push_back({name, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count()});
  }

  /// The times of the frame's passes so far.
  const std::vector<PassTime>& times() const { return times_; }

 private:
  std::vector<PassTime> times_;
};

}  // namespace catchlight::render
