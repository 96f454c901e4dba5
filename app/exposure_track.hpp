// The footage's exposure, frame by frame: of live footage, which knows what was before, and of recorded footage as a whole.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "app/exposure.hpp"
#include "app/tag_light.hpp"

namespace catchlight::app {

/// Live: each frame by its own tag. Where white is clipped, by what is not: the brightening of the surface around and of the
/// black cells since the last frame in which that channel's white was read. Where nothing can be read, the last answer is held.
class ExposureTrack {
 public:
  ExposureTrack(const CameraModel& camera, const SceneSettings& scene);

  /// Sets the row's exposure; it has its pose and state.
  void add(const Frame& frame, TrackRow& row);

  std::optional<std::string> warning() const;

 private:
  /// A frame in which a channel's white was read, kept until another one's is clipped.
  struct Reference {
    Frame frame;
    RigidTransform camera_from_tag;
    tracking::BundledTag tag;                   ///< that `plane` is of
    std::optional<tracking::PlaneLight> plane;  ///< made when first asked for
  };

  double brightening(const tracking::PlaneLight& now, const tracking::BundledTag& tag, Reference& since, int channel) const;
  MatchedExposure match_clipped(const Frame& frame, const TrackRow& row, const TagLight::Reading& reading);

  TagLight light_;
  ExposureMatcher matcher_;
  bool is_matching_;
  std::int64_t drawn_ = 0, held_ = 0, guessed_ = 0;
  std::array<std::shared_ptr<Reference>, 3> references_;  ///< by channel
};

/// Recorded: each frame by the tags of all frames within two seconds, carried over to it by the brightening of the surface
/// between. Compression, noise and a passing highlight spoil a tag of some hundred pixels more than the surface around it, and
/// a clipped frame is as good as any.
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
  struct Entry {
    double time_s = 0;
    MatchedExposure own;
    tracking::BundledTag tag;
    std::optional<tracking::PlaneLight> plane;  ///< where there was a reading
    bool has(int channel) const { return own.sources[static_cast<std::size_t>(channel)] == ExposureSource::tag; }
  };

  std::vector<std::size_t> witnesses(std::size_t entry, int channel) const;
  bool match(std::size_t entry, int channel, TrackRow& row) const;

  TagLight light_;
  double white_albedo_, black_albedo_;
  bool is_matching_;
  std::vector<Entry> entries_;
};

}  // namespace catchlight::app
