#include "app/frame_track.hpp"

#include <map>

#include "app/exposure.hpp"
#include "app/linear_patch.hpp"
#include "tracking/photometry.hpp"
#include "tracking/tracker.hpp"

namespace catchlight::app {

namespace {

/// Follows the exposure through the frames in which the tag's cells can be read.
class ExposureTrack {
 public:
  ExposureTrack(const CameraModel& camera, const SceneSettings& scene)
      : camera_(camera), target_(scene.tag.target()), matcher_(scene.tag.white_albedo, scene.tag.black_albedo) {}

  /// `row` has its pose and state. A pose that was only predicted may not lie on the cells: the exposure is held.
  void add_exposure(const Frame& frame, TrackRow& row) {
    std::optional<tracking::TagPhotometry> photometry;
    if (row.state == tracking::TrackState::tracking) photometry = measure(frame, row.camera_from_tag);
    const TagExposure exposure = matcher_.update(photometry);
    row.has_exposure = true;
    row.exposure = exposure.white;
    row.black = exposure.black;
  }

 private:
  std::optional<tracking::TagPhotometry> measure(const Frame& frame, const RigidTransform& camera_from_tag) const {
    const PixelRect region = tracking::photometry_region(camera_, camera_from_tag, target_);
    if (region.empty()) return {};
    const std::vector<float> linear = linear_rgb(frame, region);
    return tracking::measure_photometry({region, linear}, camera_, camera_from_tag, target_);
  }

  CameraModel camera_;
  tracking::TagTarget target_;
  ExposureMatcher matcher_;
};

class TagTrack : public FrameTrack {
 public:
  TagTrack(const CameraModel& camera, const SceneSettings& scene)
      : tracker_(camera, scene.tag.target(), scene.tag.tracker_options()), exposure_(camera, scene) {}

  TrackRow row(const Frame& frame) override {
    const tracking::TagObservation seen = tracker_.track(frame.luma(), frame.time_s());
    TrackRow row;
    row.frame = frame.number();
    row.time_s = frame.time_s();
    row.found = seen.state != tracking::TrackState::lost;
    row.camera_from_tag = seen.camera_from_tag;
    row.state = seen.state;
    row.corner_rms_px = seen.corner_sigma_px;
    row.ambiguity = seen.ambiguity;
    exposure_.add_exposure(frame, row);
    return row;
  }

 private:
  tracking::Tracker tracker_;
  ExposureTrack exposure_;
};

class RecordedTrack : public FrameTrack {
 public:
  RecordedTrack(std::vector<TrackRow> rows, const CameraModel& camera, const SceneSettings& scene) : exposure_(camera, scene) {
    for (TrackRow& row : rows) rows_.emplace(row.frame, std::move(row));
  }

  TrackRow row(const Frame& frame) override {
    TrackRow row;
    if (const auto found = rows_.find(frame.number()); found != rows_.end()) row = found->second;
    row.frame = frame.number();
    row.time_s = frame.time_s();
    if (!row.has_exposure) exposure_.add_exposure(frame, row);
    return row;
  }

 private:
  std::map<std::int64_t, TrackRow> rows_;
  ExposureTrack exposure_;
};

}  // namespace

std::unique_ptr<FrameTrack> make_tag_track(const CameraModel& camera, const SceneSettings& scene) {
  return std::make_unique<TagTrack>(camera, scene);
}

std::unique_ptr<FrameTrack> make_recorded_track(std::vector<TrackRow> rows, const CameraModel& camera,
                                                const SceneSettings& scene) {
  return std::make_unique<RecordedTrack>(std::move(rows), camera, scene);
}

}  // namespace catchlight::app
