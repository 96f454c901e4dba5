#include "tracking/tracker.hpp"

#include <algorithm>
#include <optional>

#include "tracking/corner_refinement.hpp"
#include "tracking/detector.hpp"
#include "tracking/families.hpp"
#include "tracking/lens.hpp"
#include "tracking/planar_pose.hpp"
#include "tracking/pose_memory.hpp"

namespace catchlight::tracking {
namespace {

using Quad = std::array<glm::dvec2, 4>;

glm::dvec2 center(const Quad& quad) {
  return (quad[0] + quad[1] + quad[2] + quad[3]) / 4.0;
}

/// Square root of the area (shoelace formula).
double side_px(const Quad& quad) {
  double doubled = 0;
  for (int i = 0; i < 4; ++i) {
    const glm::dvec2 a = quad[i], b = quad[(i + 1) % 4];
    doubled += a.x * b.y - a.y * b.x;
  }
  return std::sqrt(std::abs(doubled) / 2);
}

std::optional<Quad> project_corners(const CameraModel& camera, const RigidTransform& camera_from_tag, double size_m) {
  Quad quad;
  const auto corners_m = tag_corners_m(size_m);
  for (int i = 0; i < 4; ++i) {
    const auto corner = project_px(camera, camera_from_tag * corners_m[i]);
    if (!corner) return std::nullopt;
    quad[i] = *corner;
  }
  return quad;
}

/// Without a prediction: fewest corrected bits, then the larger.
const Detection* most_trusted(const std::vector<Detection>& candidates) {
  const auto worse = [](const Detection& a, const Detection& b) {
    if (a.hamming != b.hamming) return a.hamming > b.hamming;
    return side_px(a.corners_px) < side_px(b.corners_px);
  };
  const auto best = std::max_element(candidates.begin(), candidates.end(), worse);
  return best == candidates.end() ? nullptr : &*best;
}

/// With one: the nearest to it. A print that is both elsewhere and of another size is another copy of the tag (a
/// thumbnail, a reflection): better to coast for a moment than to jump to it.
const Detection* nearest(const std::vector<Detection>& candidates, const Quad& predicted) {
  const double predicted_side = side_px(predicted);
  const auto distance = [&](const Detection& d) { return glm::distance(center(d.corners_px), center(predicted)); };
  const auto best = std::min_element(candidates.begin(), candidates.end(),
                                     [&](const Detection& a, const Detection& b) { return distance(a) < distance(b); });
  if (best == candidates.end()) return nullptr;
  const double ratio = side_px(best->corners_px) / predicted_side;
  const bool elsewhere = distance(*best) > 1.5 * predicted_side;
  const bool other_size = std::max(ratio, 1 / ratio) > 1.5;
  return elsewhere && other_size ? nullptr : &*best;
}

void check_camera(const CameraModel& camera, const TagTarget& target, const TrackerOptions& options) {
  if (camera.width_px <= 0 || camera.height_px <= 0 || !(camera.fx_px > 0) || !(camera.fy_px > 0))
    throw Error("the camera model needs a positive image size and focal length");
  if (!(target.size_m > 0) || !std::isfinite(target.size_m))
    throw Error("the tag's size must be a positive length in metres, not " + std::to_string(target.size_m));
  if (!(options.coast_s >= 0)) throw Error("the coasting time must be 0 s or more, not " + std::to_string(options.coast_s));
}

}  // namespace

struct Tracker::Impl {
  CameraModel camera;
  TagTarget target;
  TrackerOptions options;
  TagLayout layout;
  Detector detector;
  PoseMemory memory;

  /// Where the tag should be seen now; empty once the memory is too old.
  std::optional<RigidTransform> predict(double time_s) {
    // Frame times are rounded to microseconds or coarser: a frame exactly at the limit still counts.
    if (time_s - memory.last_time_s() > options.coast_s + 1e-6) memory.forget();
    return memory.predict(time_s);
  }

  std::optional<Detection> find(const LumaView& luma, const std::optional<RigidTransform>& predicted) {
    std::vector<Detection> candidates = detector.detect(luma);
    std::erase_if(candidates, [&](const Detection& d) { return d.id != target.id; });
    const auto predicted_px = predicted ? project_corners(camera, *predicted, target.size_m) : std::nullopt;
    const Detection* chosen = predicted_px ? nearest(candidates, *predicted_px) : most_trusted(candidates);
    return chosen ? std::optional(*chosen) : std::nullopt;
  }

  std::optional<TagObservation> observe(const LumaView& luma, const Detection& detection, double time_s) {
    const RefinedCorners refined = refine_corners(luma, camera, detection.corners_px, layout);
    const auto poses = planar_poses(camera, refined.corners_px, target.size_m);
    if (poses.empty()) return std::nullopt;
    const std::size_t chosen = memory.choose(poses, time_s);
    TagObservation observation;
    observation.state = TrackState::tracking;
    observation.camera_from_tag = poses[chosen].camera_from_tag;
    observation.corners_px = refined.corners_px;
    observation.reprojection_rms_px = poses[chosen].reprojection_rms_px;
    observation.hamming = detection.hamming;
    if (poses.size() == 2) {
      // Errors far below what corners can be measured to fit alike, whatever their ratio.
      constexpr double kMeasurablePx = 1e-6;
      const double other_rms_px = poses[1 - chosen].reprojection_rms_px;
      observation.ambiguity = std::min(1.0, (observation.reprojection_rms_px + kMeasurablePx) / (other_rms_px + kMeasurablePx));
    }
    return observation;
  }
};

Tracker::Tracker(const CameraModel& camera, const TagTarget& target, const TrackerOptions& options) {
  check_camera(camera, target, options);
  impl_ = std::make_unique<Impl>(
      Impl{camera, target, options, tag_layout(target.family, target.id), Detector(target.family, options), PoseMemory()});
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
  if (const auto detection = impl_->find(luma, predicted))
    if (const auto observation = impl_->observe(luma, *detection, time_s)) return *observation;

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
