// Tracks recorded footage: every frame may know what comes after it.
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/luma_view.hpp"
#include "catchlight/tag.hpp"
#include "tracking/observation.hpp"
#include "tracking/tracker.hpp"
#include "tracking/tracker_options.hpp"
#include "tracking/trajectory/solver.hpp"

namespace catchlight::tracking {

class ShotTracker {
 public:
  /// Throws Error as Tracker does.
  ShotTracker(const CameraModel& camera, const TagTarget& target, const TrackerOptions& options = {});

  /// Frames come in order. What the frame shows with the ones before it; where the tag has just come into view, the frames before
  /// are looked at again from there, backward: a tag that is still cut off by the picture's edge, or still blurred, can be
  /// followed where it cannot be detected.
  const TagObservation& add(const LumaView& luma, double time_s);

  /// One pose a frame, from all of them.
  std::vector<SolvedPose> solve() const;

  /// How each frame shows the print; empty where it was not refined directly.
  const std::vector<std::optional<TagAppearance>>& appearances() const { return appearances_; }

 private:
  struct Kept {
    std::size_t frame;
    double time_s;
    LumaView luma;
    std::vector<std::uint8_t> codes;
  };
  void keep(const LumaView& luma, double time_s);
  void look_back();
  void record(std::size_t frame, const TagObservation& seen);

  CameraModel camera_;
  TagTarget target_;
  TrackerOptions options_;
  Tracker forward_;
  TagObservation last_;
  std::vector<TrajectoryFrame> frames_;
  std::vector<std::optional<TagAppearance>> appearances_;
  std::deque<Kept> kept_;  ///< the last frames
};

}  // namespace catchlight::tracking
