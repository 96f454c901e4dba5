#include "app/session/frame_track.hpp"

#include <algorithm>
#include <map>

#include "app/session/absent_tag.hpp"
#include "app/session/frame_view.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"
#include "tracking/camera/blur.hpp"
#include "tracking/camera/exposure_match.hpp"
#include "tracking/camera/grain.hpp"
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

/// Sets the row's pose; a tag that has left the picture is lost.
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

/// What one frame alone shows, before its exposure, noise and blur are known.
TrackRow row_of(const Frame& frame, const tracking::TagObservation& seen, const CameraModel& camera, const TagTarget& target) {
  TrackRow row;
  row.frame = frame.number();
  row.time_s = frame.time_s();
  set_pose(row, seen.state, seen.camera_from_tag, camera, target);
  if (row.found) row.pose_covariance = seen.covariance;
  row.corner_sigma_px = seen.corner_sigma_px;
  row.ambiguity = seen.ambiguity;
  set_appearance(row, seen.appearance);
  return row;
}

tracking::ExposureMatch exposure_match(const CameraModel& camera, const SceneSettings& scene) {
  return {camera, scene.tag.target(), {scene.tag.white_albedo, scene.tag.black_albedo}};
}

/// What to say where the exposure could not be read; that matters only where the virtual layer follows it.
std::optional<std::string> exposure_warning(const tracking::ExposureCounts& counts, const SceneSettings::Exposure& settings) {
  return follows_footage(settings.mode) ? counts.warning() : std::nullopt;
}

std::optional<std::string> text_of(const AbsentTag& absent, const TagTarget& target) {
  return absent.is_absent() ? std::optional(absent.text(target)) : std::nullopt;
}

class TagTrack : public FrameTrack {
 public:
  TagTrack(const CameraModel& camera, const SceneSettings& scene)
      : camera_(camera),
        target_(scene.tag.target()),
        settings_(scene.exposure),
        tracker_(camera, target_, scene.tag.tracker_options()),
        exposure_(exposure_match(camera, scene)),
        grain_(camera, target_),
        blur_(camera, target_.size_m) {}

  TrackRow row(const Frame& frame) override {
    TrackRow row = row_of(frame, tracker_.track(frame.luma(), frame.time_s()), camera_, target_);
    exposure_.add(frame, row);
    exposure_.set_latest(row);
    grain_.add(frame, row);
    row.noise = grain_.model();
    blur_.add(row);
    absent_.add(frame, row.found);
    return row;
  }

  bool is_tracking() const override { return true; }
  bool finds_any(const FrameRange&) const override { return true; }
  std::optional<std::string> warning() const override { return exposure_warning(exposure_.counts(), settings_); }
  std::optional<std::string> never_found() const override { return text_of(absent_, target_); }

 private:
  CameraModel camera_;
  TagTarget target_;
  SceneSettings::Exposure settings_;
  tracking::Tracker tracker_;
  tracking::ExposureMatch exposure_;
  tracking::GrainMeter grain_;
  tracking::BlurMeter blur_;
  AbsentTag absent_;
};

class RecordedTrack : public FrameTrack {
 public:
  RecordedTrack(std::vector<TrackRow> rows, const CameraModel& camera, const SceneSettings& scene)
      : settings_(scene.exposure), exposure_(exposure_match(camera, scene)) {
    for (TrackRow& row : rows) rows_.emplace(row.frame, std::move(row));
  }

  TrackRow row(const Frame& frame) override {
    TrackRow row;
    if (const auto found = rows_.find(frame.number()); found != rows_.end()) row = found->second;
    row.frame = frame.number();
    row.time_s = frame.time_s();
    if (row.has_exposure) return row;
    exposure_.add(frame, row);
    exposure_.set_latest(row);
    return row;
  }

  bool is_tracking() const override { return false; }
  bool finds_any(const FrameRange& range) const override {
    return std::ranges::any_of(rows_, [&](const auto& entry) { return range.contains(entry.first) && entry.second.found; });
  }
  std::vector<TrackRow> known_rows() const override {
    std::vector<TrackRow> rows;
    rows.reserve(rows_.size());
    for (const auto& entry : rows_) rows.push_back(entry.second);
    return rows;
  }
  std::optional<TrackRow> middle_row(const FrameRange& range) const override {
    std::vector<const TrackRow*> found;
    for (const auto& [number, row] : rows_)
      if (range.contains(number) && row.found) found.push_back(&row);
    if (found.empty()) return std::nullopt;
    const auto middle = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2);
    std::ranges::nth_element(found, middle, {},
                             [](const TrackRow* row) { return glm::length(row->camera_from_tag.translation_m); });
    return **middle;
  }
  std::optional<std::string> warning() const override { return exposure_warning(exposure_.counts(), settings_); }

 private:
  std::map<std::int64_t, TrackRow> rows_;
  SceneSettings::Exposure settings_;
  tracking::ExposureMatch exposure_;
};

}  // namespace

struct ShotTrack::Impl {
  CameraModel camera;
  TagTarget target;
  SceneSettings::Exposure settings;
  tracking::ShotTracker tracker;
  tracking::ExposureMatch exposure;
  tracking::GrainMeter grain;
  AbsentTag absent;
  tracking::FocalMeter focal;
  std::vector<TrackRow> rows;
};

ShotTrack::ShotTrack(const CameraModel& camera, const SceneSettings& scene) {
  const TagTarget target = scene.tag.target();
  impl_ = std::make_unique<Impl>(Impl{camera,
                                      target,
                                      scene.exposure,
                                      tracking::ShotTracker(camera, target, scene.tag.tracker_options()),
                                      exposure_match(camera, scene),
                                      tracking::GrainMeter(camera, target),
                                      {},
                                      tracking::FocalMeter(camera, target),
                                      {}});
}

ShotTrack::~ShotTrack() = default;

void ShotTrack::add(const Frame& frame) {
  const tracking::TagObservation& seen = impl_->tracker.add(frame.luma(), frame.time_s());
  if (seen.state == TrackState::tracking) impl_->focal.add(frame.luma(), seen.corners_px);
  const TrackRow row = row_of(frame, seen, impl_->camera, impl_->target);
  impl_->exposure.add(frame, row);
  impl_->grain.add(frame, row);
  impl_->absent.add(frame, row.found);
  impl_->rows.push_back(row);
}

std::vector<TrackRow> ShotTrack::solve() const {
  std::vector<TrackRow> rows = impl_->rows;
  const std::vector<tracking::SolvedPose> poses = impl_->tracker.solve();
  const NoiseModel noise = impl_->grain.model();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    set_pose(rows[i], poses[i].state, poses[i].camera_from_tag, impl_->camera, impl_->target);
    rows[i].pose_covariance = rows[i].found ? std::optional(poses[i].covariance) : std::nullopt;
    rows[i].ambiguity = poses[i].ambiguity;
    rows[i].corner_sigma_px = rows[i].found ? tracking::corner_sigma_px(impl_->camera, poses[i].camera_from_tag,
                                                                        poses[i].covariance, impl_->target.size_m)
                                            : 0;
    set_appearance(rows[i], impl_->tracker.appearances()[i]);
    rows[i].noise = noise;
  }
  impl_->exposure.set_all(rows);
  tracking::measure_blur(rows, impl_->camera, impl_->target.size_m);
  return rows;
}

std::optional<tracking::FocalEstimate> ShotTrack::focal_length() const {
  return impl_->focal.estimate();
}

std::optional<std::string> ShotTrack::warning(const std::vector<TrackRow>& rows) const {
  return exposure_warning(impl_->exposure.counts(rows), impl_->settings);
}

std::optional<std::string> ShotTrack::never_found() const {
  return text_of(impl_->absent, impl_->target);
}

std::unique_ptr<FrameTrack> make_tag_track(const CameraModel& camera, const SceneSettings& scene) {
  return std::make_unique<TagTrack>(camera, scene);
}

std::unique_ptr<FrameTrack> make_recorded_track(std::vector<TrackRow> rows, const CameraModel& camera,
                                                const SceneSettings& scene) {
  return std::make_unique<RecordedTrack>(std::move(rows), camera, scene);
}

}  // namespace catchlight::app
