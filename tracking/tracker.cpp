#include "tracking/tracker.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/error.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/track.hpp"
#include "tracking/detection/tag_search.hpp"
#include "tracking/pose/corner_noise.hpp"
#include "tracking/pose/planar_pose.hpp"
#include "tracking/pose/pose_covariance.hpp"
#include "tracking/pose/pose_memory.hpp"
#include "tracking/refinement/corner_refinement.hpp"
#include "tracking/refinement/direct_refinement.hpp"

namespace catchlight::tracking {
namespace {

constexpr double kDetectedErrorPx = 2;               ///< the detector's corners in a smaller picture
constexpr double kMinErrorPx = 1, kMaxErrorPx = 16;  ///< a prediction's; more than that is for the detector to find
constexpr double kFirstErrorPx = 6;                  ///< the first prediction's, which knows no motion
constexpr double kMaxSigmaPx = 2;                    ///< a fit whose corners are less certain is none

void check_camera(const CameraModel& camera, const TagTarget& target, const TrackerOptions& options) {
  if (camera.width_px <= 0 || camera.height_px <= 0 || !(camera.fx_px > 0) || !(camera.fy_px > 0))
    throw Error("the camera model needs a positive image size and focal length");
  for (const BundledTag& tag : target.tags())
    if (!(tag.size_m > 0) || !std::isfinite(tag.size_m))
      throw Error("the tag's size must be a positive length in metres, not " + std::to_string(tag.size_m));
  if (!(options.coast_s >= 0)) throw Error("the coasting time must be 0 s or more, not " + std::to_string(options.coast_s));
}

/// A frame's poses, the likelier first, and what the tag looked like.
struct Measurement {
  std::vector<PoseCandidate> candidates;
  std::optional<TagAppearance> appearance;
};

PoseCandidate candidate(const DirectFit& fit) {
  return {fit.camera_from_tag, fit.covariance, fit.log_likelihood};
}

}  // namespace

struct Tracker::Impl {
  CameraModel camera;
  TagTarget target;
  TrackerOptions options;
  std::vector<BundledTag> tags;
  TagSearch search;
  DirectRefiner refiner;
  CornerNoise corner_noise;
  PoseMemory memory;
  Covariance2 blur_px2{0.5, 0, 0.5};  ///< as last seen
  double error_px = kFirstErrorPx;    ///< how far predictions have been off

  Impl(const CameraModel& camera_model, const TagTarget& tag_target, const TrackerOptions& tracker_options)
      : camera(camera_model),
        target(tag_target),
        options(tracker_options),
        tags(tag_target.tags()),
        search(camera_model, tag_target, tracker_options),
        refiner(camera_model, tag_target) {}

  /// The pose in which the tag should be seen now; empty once the memory is too old.
  std::optional<RigidTransform> predict(double time_s) {
    // Frame times are rounded to microseconds or coarser: a frame exactly at the limit still counts.
    if (time_s - memory.last_time_s() > options.coast_s + 1e-6) {
      memory.forget();
      error_px = kFirstErrorPx;
    }
    return memory.predict(time_s);
  }

  /// The pattern itself, from a pose that may be `off_px` away.
  std::optional<Measurement> refined(const LumaView& luma, const RigidTransform& camera_from_tag, double off_px) {
    auto fit = refiner.refine(luma, {camera_from_tag, blur_px2, off_px});
    if (!fit || !is_convincing(*fit)) return std::nullopt;
    if (!(corner_sigma_px(camera, fit->camera_from_tag, fit->covariance, target.size_m) < kMaxSigmaPx)) return std::nullopt;
    Measurement measurement;
    const auto other = refiner.other_pose(*fit);
    measurement.candidates.push_back(candidate(*fit));
    if (other) measurement.candidates.push_back(candidate(*other));
    if (other && other->log_likelihood > fit->log_likelihood) std::swap(measurement.candidates[0], measurement.candidates[1]);
    const DirectFit& best = other && other->log_likelihood > fit->log_likelihood ? *other : *fit;
    measurement.appearance =
        TagAppearance{best.white_linear, best.black_linear, best.blur_px2, best.noise_codes, best.occluded_share};
    return measurement;
  }

  /// From corners that only the detector has seen, either planar pose may be the right one. The likelier is taken where it
  /// explains the whole tag; else the one that explains more: a pose that has to call part of the tag occluded explains less,
  /// however little noise it leaves elsewhere.
  std::optional<Measurement> refined_from_both(const LumaView& luma, const std::vector<PoseHypothesis>& poses,
                                               const RigidTransform& this_from_tag) {
    constexpr double kOccluded = 0.1;
    std::optional<Measurement> best;
    const auto is_better = [](const TagAppearance& a, const TagAppearance& b) {
      if (std::abs(a.occluded_share - b.occluded_share) > kOccluded) return a.occluded_share < b.occluded_share;
      return a.noise_codes < b.noise_codes;
    };
    for (const PoseHypothesis& pose : poses) {
      auto fit = refined(luma, pose.camera_from_tag * this_from_tag, kDetectedErrorPx);
      if (fit && (!best || is_better(*fit->appearance, *best->appearance))) best = std::move(fit);
      if (best && best->appearance->occluded_share < kOccluded) break;
    }
    return best;
  }

  std::optional<Measurement> measured(const LumaView& luma, const Sighting& sighting) {
    const BundledTag& tag = tags[sighting.tag];
    const RigidTransform this_from_tag = inverse(tag.tag_from_this);
    Quad corners_px = sighting.detection.corners_px;
    if (options.refinement == Refinement::direct)
      if (auto fit = refined_from_both(luma, planar_poses(camera, corners_px, tag.size_m), this_from_tag)) return fit;
    if (options.refinement != Refinement::none)
      corners_px = refine_corners(luma, camera, corners_px, tag_layout(tag.family, tag.id)).corners_px;
    const auto poses = planar_poses(camera, corners_px, tag.size_m);
    if (poses.empty()) return std::nullopt;
    Measurement measurement{corner_noise.candidates(camera, poses, tag.size_m), {}};
    for (PoseCandidate& each : measurement.candidates) each.camera_from_tag = each.camera_from_tag * this_from_tag;
    return measurement;
  }

  std::optional<Measurement> measure(const LumaView& luma, const std::optional<RigidTransform>& predicted) {
    if (predicted && options.refinement == Refinement::direct) {
      if (auto followed = refined(luma, *predicted, error_px)) return followed;
      if (const auto sighting = search.near(luma, *predicted, kMaxErrorPx))
        if (auto measurement = measured(luma, *sighting)) return measurement;
    }
    const auto sighting = search.anywhere(luma, predicted);
    return sighting ? measured(luma, *sighting) : std::nullopt;
  }

  TagObservation observed(const Measurement& measurement, const std::optional<RigidTransform>& predicted, double time_s) {
    const PoseCandidate& chosen = measurement.candidates[memory.choose(measurement.candidates, time_s)];
    TagObservation observation;
    observation.state = TrackState::tracking;
    observation.camera_from_tag = chosen.camera_from_tag;
    observation.covariance = chosen.covariance;
    observation.corner_sigma_px = corner_sigma_px(camera, chosen.camera_from_tag, chosen.covariance, target.size_m);
    observation.ambiguity = memory.ambiguity();
    observation.candidates = measurement.candidates;
    observation.appearance = measurement.appearance;
    const auto corners_px = project_corners(camera, chosen.camera_from_tag, target.size_m);
    if (corners_px) observation.corners_px = *corners_px;
    if (measurement.appearance) blur_px2 = measurement.appearance->blur_px2;
    const auto expected_px = predicted ? project_corners(camera, *predicted, target.size_m) : std::nullopt;
    if (corners_px && expected_px) learn_error(*corners_px, *expected_px);
    return observation;
  }

  /// Twice the worst of what predictions were lately off.
  void learn_error(const Quad& seen_px, const Quad& expected_px) {
    double off_px = 0;
    for (int i = 0; i < 4; ++i) off_px = std::max(off_px, glm::distance(seen_px[i], expected_px[i]));
    error_px = std::clamp(std::max(2 * off_px, 0.8 * error_px), kMinErrorPx, kMaxErrorPx);
  }
};

Tracker::Tracker(const CameraModel& camera, const TagTarget& target, const TrackerOptions& options) {
  check_camera(camera, target, options);
  impl_ = std::make_unique<Impl>(camera, target, options);
}

Tracker::~Tracker() = default;
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;

TagObservation Tracker::track(const LumaView& luma, double time_s) {
  const CameraModel& camera = impl_->camera;
  if (luma.width_px != camera.width_px || luma.height_px != camera.height_px)
    throw Error("the frame is " + std::to_string(luma.width_px) + "x" + std::to_string(luma.height_px) +
                ", the camera file is for " + std::to_string(camera.width_px) + "x" + std::to_string(camera.height_px) +
                "; use the calibration of this footage, or scale it");

  const auto predicted = impl_->predict(time_s);
  if (const auto measurement = impl_->measure(luma, predicted)) return impl_->observed(*measurement, predicted, time_s);

  TagObservation unseen;
  if (!predicted) return unseen;
  const auto corners_px = project_corners(camera, *predicted, impl_->target.size_m);
  if (!corners_px) return unseen;
  unseen.state = TrackState::coasting;
  unseen.camera_from_tag = *predicted;
  unseen.corners_px = *corners_px;
  return unseen;
}

}  // namespace catchlight::tracking
