#include "app/session/frame_track.hpp"

#include <map>

#include "app/photometry/exposure_track.hpp"
#include "app/photometry/lens_blur.hpp"
#include "app/photometry/lens_noise.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"
#include "tracking/observation.hpp"
#include "tracking/pose/planar_pose.hpp"
#include "tracking/pose/pose_covariance.hpp"
#include "tracking/shot_tracker.hpp"
#include "tracking/tracker.hpp"

namespace catchlight::app {

namespace {

/// Whether any of the target can be in the picture.
bool is_in_picture(const CameraModel& camera, const TagTarget& target, const RigidTransform& camera_from_tag) {
  for (const BundledTag& tag : target.tags()) {
    const auto quad = tracking::project_corners(camera, camera_from_tag * tag.tag_from_this, tag.size_m);
    if (!quad) continue;
    glm::dvec2 low = (*quad)[0], high = low;
    for (const glm::dvec2& corner : *quad) {
      low = glm::min(low, corner);
      high = glm::max(high, corner);
    }
    if (high.x >= -0.5 && high.y >= -0.5 && low.x <= camera.width_px - 0.5 && low.y <= camera.height_px - 0.5) return true;
  }
  return false;
}

/// A row's pose; a tag that went on out of the picture is lost.
void set_pose(TrackRow& row, TrackState state, const RigidTransform& camera_from_tag, const CameraModel& camera,
              const TagTarget& target) {
  const bool is_lost = state == TrackState::lost || !is_in_picture(camera, target, camera_from_tag);
  row.found = !is_lost;
  row.state = is_lost ? TrackState::lost : state;
  row.camera_from_tag = camera_from_tag;
}

void set_appearance(TrackRow& row, const std::optional<tracking::TagAppearance>& appearance) {
  if (!appearance) return;
  row.blur_px2 = appearance->blur_px2;
  row.noise_codes = appearance->noise_codes;
}

TrackRow row_of(const Frame& frame) {
  TrackRow row;
  row.frame = frame.number();
  row.time_s = frame.time_s();
  return row;
}

class TagTrack : public FrameTrack {
 public:
  TagTrack(const CameraModel& camera, const SceneSettings& scene)
      : camera_(camera),
        target_(scene.tag.target()),
        tracker_(camera, target_, scene.tag.tracker_options()),
        exposure_(camera, scene),
        noise_(camera, target_),
        lens_blur_(camera, target_.size_m) {}

  TrackRow row(const Frame& frame) override {
    const tracking::TagObservation seen = tracker_.track(frame.luma(), frame.time_s());
    TrackRow row = row_of(frame);
    set_pose(row, seen.state, seen.camera_from_tag, camera_, target_);
    row.corner_sigma_px = seen.corner_sigma_px;
    row.ambiguity = seen.ambiguity;
    set_appearance(row, seen.appearance);
    exposure_.add(frame, row);
    noise_.add(frame, row);
    row.noise = noise_.model();
    lens_blur_.add(row);
    return row;
  }

  bool is_tracking() const override { return true; }
  std::optional<std::string> warning() const override { return exposure_.warning(); }

 private:
  CameraModel camera_;
  TagTarget target_;
  tracking::Tracker tracker_;
  ExposureTrack exposure_;
  NoiseMeter noise_;
  LensBlurMeter lens_blur_;
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
    if (!row.has_exposure) exposure_.add(frame, row);
    return row;
  }

  bool is_tracking() const override { return false; }
  std::optional<std::string> warning() const override { return exposure_.warning(); }

 private:
  std::map<std::int64_t, TrackRow> rows_;
  ExposureTrack exposure_;
};

}  // namespace

struct PathTrack::Impl {
  CameraModel camera;
  TagTarget target;
  tracking::RecordedPath path;
  ExposurePath exposure;
  NoiseMeter noise;
  std::vector<TrackRow> rows;
};

PathTrack::PathTrack(const CameraModel& camera, const SceneSettings& scene) {
  const TagTarget target = scene.tag.target();
  impl_ = std::make_unique<Impl>(Impl{camera,
                                      target,
                                      tracking::RecordedPath(camera, target, scene.tag.tracker_options()),
                                      ExposurePath(camera, scene),
                                      NoiseMeter(camera, target),
                                      {}});
}

PathTrack::~PathTrack() = default;

void PathTrack::add(const Frame& frame) {
  const tracking::TagObservation& seen = impl_->path.add(frame.luma(), frame.time_s());
  TrackRow row = row_of(frame);
  set_pose(row, seen.state, seen.camera_from_tag, impl_->camera, impl_->target);
  set_appearance(row, seen.appearance);
  impl_->exposure.add(frame, row);
  impl_->noise.add(frame, row);
  impl_->rows.push_back(row);
}

std::vector<TrackRow> PathTrack::solve() const {
  std::vector<TrackRow> rows = impl_->rows;
  const std::vector<tracking::SolvedPose> poses = impl_->path.solve();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    set_pose(rows[i], poses[i].state, poses[i].camera_from_tag, impl_->camera, impl_->target);
    rows[i].ambiguity = poses[i].ambiguity;
    if (rows[i].found)
      rows[i].corner_sigma_px =
          tracking::corner_sigma_px(impl_->camera, poses[i].camera_from_tag, poses[i].covariance, impl_->target.size_m);
    set_appearance(rows[i], impl_->path.appearances()[i]);
  }
  impl_->exposure.fill_in(rows);
  const NoiseModel noise = impl_->noise.model();
  for (TrackRow& row : rows) row.noise = noise;
  measure_lens_blur(rows, impl_->camera, impl_->target.size_m);
  return rows;
}

std::optional<std::string> PathTrack::warning(const std::vector<TrackRow>& rows) const {
  return impl_->exposure.warning(rows);
}

std::unique_ptr<FrameTrack> make_tag_track(const CameraModel& camera, const SceneSettings& scene) {
  return std::make_unique<TagTrack>(camera, scene);
}

std::unique_ptr<FrameTrack> make_recorded_track(std::vector<TrackRow> rows, const CameraModel& camera,
                                                const SceneSettings& scene) {
  return std::make_unique<RecordedTrack>(std::move(rows), camera, scene);
}

}  // namespace catchlight::app
