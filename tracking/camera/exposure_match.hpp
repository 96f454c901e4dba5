// The footage's exposure, frame by frame: of live footage, which knows what was before, and of recorded footage as a whole.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "catchlight/track.hpp"
#include "tracking/camera/exposure_reading.hpp"

namespace catchlight::tracking {

/// The number of frames with a pose, and of those whose exposure is less than sure.
struct ExposureCounts {
  std::int64_t found = 0, held = 0, guessed = 0;
  void add(const ExposureReading& reading, bool is_found);

  /// What the user should know of them; empty where all is well.
  std::optional<std::string> warning() const;
};

/// Matches the exposures of frames with each other: a frame's exposure is the median of what the tags of all frames within two
/// seconds say, each carried over to it by the brightening of the surface between. Compression, noise and a passing highlight
/// spoil a tag of some hundred pixels more than the surface around it, and a clipped frame is as good as any. Every answer is
/// measured against frames that were read, so nothing accumulates and nothing drifts.
class ExposureMatch {
 public:
  ExposureMatch(const CameraModel& camera, const TagTarget& target, const TagAlbedo& albedo) : reader_(camera, target, albedo) {}

  /// Reads the frame; its row has pose and state. Frames come in order.
  void add(const FrameImage& frame, const TrackRow& row);

  /// Live: sets the exposure of the frame just added, by itself and the frames before. Where nothing can be read, the last answer
  /// is held. Frames that no later one asks are forgotten.
  void set_latest(TrackRow& row);

  /// Recorded: sets the exposure of the rows of all frames added, each by the frames before and after. Over frames without a
  /// reading it goes evenly (in stops) from the one before to the one after.
  void set_all(std::vector<TrackRow>& rows) const;

  /// Counts the rows of all frames added.
  ExposureCounts counts(const std::vector<TrackRow>& rows) const;

  /// Counts the frames that set_latest() was asked for.
  const ExposureCounts& counts() const { return counts_; }

 private:
  void forget();

  ExposureReader reader_;
  std::deque<ExposureReading> readings_;
  TagExposure latest_;
  ExposureCounts counts_;
};

}  // namespace catchlight::tracking
