// Finds a tag, or a board of them, in each frame and says where it is. No GL, no video.
#pragma once

#include <memory>

#include "catchlight/camera.hpp"
#include "catchlight/luma_view.hpp"
#include "catchlight/tag.hpp"
#include "tracking/observation.hpp"
#include "tracking/tracker_options.hpp"

namespace catchlight::tracking {

/// Stateful: remembers the last frames to choose between the two planar poses and to coast.
/// Throws Error for an unknown family (naming those there are) and for a luma plane of another size than the camera's.
class Tracker {
 public:
  Tracker(const CameraModel& camera, const TagTarget& target, const TrackerOptions& options = {});
  ~Tracker();
  Tracker(Tracker&&) noexcept;
  Tracker& operator=(Tracker&&) noexcept;

  /// Frames come in order; `time_s` never decreases.
  TagObservation track(const LumaView& luma, double time_s);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catchlight::tracking
