// The row of the track for each frame (pose and exposure), tracked from the pictures or read from a track file.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/media/frame_range.hpp"
#include "app/media/pixels/frame.hpp"
#include "app/settings/scene_settings.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/track.hpp"
#include "tracking/camera/focal_length.hpp"

namespace catchlight::app {

class FrameTrack {
 public:
  virtual ~FrameTrack() = default;

  /// The frame's row. Frames come in order, none is left out.
  virtual TrackRow row(const Frame& frame) = 0;

  /// Whether row() tracks, or only looks up what is known.
  virtual bool is_tracking() const = 0;

  /// Whether the tag may be found in any frame of the range.
  virtual bool finds_any(const FrameRange& range) const = 0;

  /// The row at the middle distance from the tag, of those in the range that have a pose and are known beforehand.
  virtual std::optional<TrackRow> middle_row(const FrameRange&) const { return std::nullopt; }

  /// All rows that are known beforehand, in order.
  virtual std::vector<TrackRow> known_rows() const { return {}; }

  /// What the user should know of the rows so far, if anything.
  virtual std::optional<std::string> warning() const = 0;

  /// What to say where this track has looked for the tag and found it in no frame so far.
  virtual std::optional<std::string> never_found() const { return std::nullopt; }
};

/// Tracks the tag causally, for live footage: each row knows the frames before it. Measures the tag's photometry.
std::unique_ptr<FrameTrack> make_tag_track(const CameraModel& camera, const SceneSettings& scene);

/// Tracks recorded footage, where each row may know what comes after it.
class ShotTrack {
 public:
  ShotTrack(const CameraModel& camera, const SceneSettings& scene);
  ~ShotTrack();

  /// Tracks a frame. Frames come in order, none is left out.
  void add(const Frame& frame);

  /// One row a frame. Exposures are those of recorded footage in tracking/camera/exposure_match.hpp.
  std::vector<TrackRow> solve() const;

  /// What the tag's views say of the focal length; empty where they say nothing.
  std::optional<tracking::FocalEstimate> focal_length() const;

  /// What the user should know of the rows that solve() gave, if anything.
  std::optional<std::string> warning(const std::vector<TrackRow>& rows) const;

  /// What to say where the tag is in none of the frames.
  std::optional<std::string> never_found() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Looks up each frame in `rows`; one that they do not have counts as lost. Rows without exposure (bare poses) are measured in
/// the pictures.
std::unique_ptr<FrameTrack> make_recorded_track(std::vector<TrackRow> rows, const CameraModel& camera,
                                                const SceneSettings& scene);

}  // namespace catchlight::app
