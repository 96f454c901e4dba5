// Times the named passes of a frame and groups their GL calls under the same names for debuggers.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "render/gl/gl_objects.hpp"
#include "render/pass_time.hpp"

namespace catchlight::render {

class PassClock {
 public:
  /// A pass, which lasts as long as its scope lives. Passes do not nest.
  class Scope {
   public:
    Scope(PassClock& clock, const char* name);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
  };

  /// Forgets the last frame's passes.
  void begin_frame();
  [[nodiscard]] Scope pass(const char* name) { return Scope(*this, name); }

  /// The times of the last frame's passes; waits for the GPU's figures.
  std::vector<PassTime> times() const;

 private:
  std::vector<std::string> names_;
  std::vector<GlQuery> queries_;  ///< kept from frame to frame; the first names_.size() are in use
  std::chrono::steady_clock::time_point frame_start_;
};

}  // namespace catchlight::render
