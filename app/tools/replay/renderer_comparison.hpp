// What the processor draws against what OpenGL draws.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/session/shot_renderer.hpp"

namespace catchlight::app {

/// How far two pictures of a frame are apart: of each pixel the largest difference of its channels' codes, of 255; of these the
/// mean and the 99th percentile over the frame.
struct CodeDifference {
  double mean = 0, p99 = 0;
};

CodeDifference code_difference(const Frame& plate, const Composite& one, const Composite& other);

/// The greatest of a recording's frames.
struct RendererDifference {
  int frames = 0;
  CodeDifference worst;
  std::int64_t frame_of_mean = 0, frame_of_p99 = 0;  ///< their numbers
};

/// The renderers draw the same picture where no frame's differ by more.
inline constexpr CodeDifference kMaxRendererDifference{.mean = 0.3, .p99 = 2};

/// One line for each figure that is beyond what it may be.
std::vector<std::string> drift(const RendererDifference& difference);

/// Draws frames that the processor drew a second time with OpenGL.
class RendererComparison {
 public:
  /// `settings`: those that the processor drew with. Throws Error where there is no OpenGL.
  RendererComparison(SceneSettings settings, const CameraModel& camera, Log& log);

  /// Takes every frame, in order, on one thread: the exposure adapts to each.
  void compare(const FrameJob& drawn);

  const RendererDifference& difference() const { return difference_; }

 private:
  ShotRenderer gl_;
  RendererDifference difference_;
};

}  // namespace catchlight::app
