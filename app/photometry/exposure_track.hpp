// The footage's exposure, frame by frame: of live footage, which knows what was before, and of recorded footage as a whole.
#pragma once

#include <deque>
#include <vector>

#include "app/photometry/exposure.hpp"
#include "app/photometry/tag_light.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/tag.hpp"
#include "catchlight/track.hpp"

namespace catchlight::app {

/// What one frame shows. Frames bear witness for each other: a frame's exposure is the median of what the tags of all frames
/// within two seconds say, carried over to it by the brightening of the surface between. Compression, noise and a passing
/// highlight spoil a tag of some hundred pixels more than the surface around it, and a clipped frame is as good as any. Every
/// answer is measured against frames that were read, so nothing accumulates and nothing drifts.
struct ExposureWitness {
  double time_s = 0;
  TagReading own;
  BundledTag tag;                             ///< that was read
  std::optional<tracking::PlaneLight> plane;  ///< empty where no tag was read
  bool knows(int channel) const { return own.sources[static_cast<std::size_t>(channel)] == ExposureSource::tag; }
};

/// Makes witnesses of frames.
class ExposureReader {
 public:
  ExposureReader(const CameraModel& camera, const SceneSettings& scene);
  ExposureWitness read(const Frame& frame, const TrackRow& row) const;

 private:
  TagLight light_;
  double white_albedo_, black_albedo_;
};

/// Of how many frames the exposure is less than sure.
struct ExposureDoubts {
  std::int64_t drawn = 0, held = 0, guessed = 0;
  void add(const ExposureWitness& frame, bool is_drawn);
};

/// Live: each frame by itself and the frames before. Where nothing can be read, the last answer is held.
class ExposureTrack {
 public:
  ExposureTrack(const CameraModel& camera, const SceneSettings& scene);

  /// Sets the row's exposure; it has its pose and state.
  void add(const Frame& frame, TrackRow& row);

  std::optional<std::string> warning() const;

 private:
  void forget();

  ExposureReader reader_;
  bool is_matching_;
  ExposureDoubts doubts_;
  std::deque<ExposureWitness> witnesses_;  ///< of the last two seconds, and the last that knew a channel
  TagExposure current_;
};

/// Recorded: each frame by the frames before and after.
class ExposurePath {
 public:
  ExposurePath(const CameraModel& camera, const SceneSettings& scene);

  /// In the order of the rows; the row has its pose and state.
  void add(const Frame& frame, const TrackRow& row);

  /// Sets the exposure of all rows that were added. Over frames without a reading it goes evenly (in stops) from the one before
  /// to the one after.
  void fill_in(std::vector<TrackRow>& rows) const;

  /// Of the rows that fill_in() has filled in.
  std::optional<std::string> warning(const std::vector<TrackRow>& rows) const;

 private:
  ExposureReader reader_;
  bool is_matching_;
  std::deque<ExposureWitness> witnesses_;
};

}  // namespace catchlight::app
