#include "tracking/camera/exposure_reading.hpp"

#include <algorithm>

#include "catchlight/pixel_rect.hpp"
#include "catchlight/rigid_transform.hpp"

namespace catchlight::tracking {
namespace {

TagTarget alone(const BundledTag& tag) {
  return {tag, {}};
}

struct SeenTag {
  TagPhotometry photometry;
  BundledTag tag;
};

std::optional<SeenTag> seen_tag(const FrameImage& frame, const TrackRow& row, const CameraModel& camera,
                                const TagTarget& target) {
  if (row.state != TrackState::tracking) return std::nullopt;
  const std::optional<Covariance2> blur_px2 = row.noise_codes > 0 ? std::optional(row.blur_px2) : std::nullopt;
  std::optional<SeenTag> clipped;
  for (const BundledTag& tag : target.tags()) {
    const RigidTransform camera_from_this = row.camera_from_tag * tag.tag_from_this;
    const PixelRect region = photometry_region(camera, camera_from_this, alone(tag));
    if (region.empty()) continue;
    const LinearPatch patch = linear_patch(frame.rgb(region), frame.color());
    const auto seen = measure_photometry(patch, camera, camera_from_this, alone(tag), blur_px2);
    if (seen && !glm::any(seen->is_clipped)) return SeenTag{*seen, tag};
    if (seen && !clipped) clipped = SeenTag{*seen, tag};
  }
  return clipped;
}

/// The light of the plane that `tag` lies in; nothing is known where it is out of sight.
PlaneLight seen_plane(const FrameImage& frame, const RigidTransform& camera_from_tag, const BundledTag& tag,
                      const CameraModel& camera) {
  const RigidTransform camera_from_this = camera_from_tag * tag.tag_from_this;
  const PixelRect region = plane_region(camera, camera_from_this, alone(tag));
  if (region.empty()) return {};
  return measure_plane(linear_patch(frame.rgb(region), frame.color()), camera, camera_from_this, alone(tag));
}

}  // namespace

bool ExposureReading::is_guessed() const {
  return std::find(own.sources.begin(), own.sources.end(), ExposureSource::black) != own.sources.end();
}

ExposureReading ExposureReader::read(const FrameImage& frame, const TrackRow& row) const {
  ExposureReading reading;
  reading.time_s = row.time_s;
  if (const auto seen = seen_tag(frame, row, camera_, target_)) {
    reading.own = read_exposure(seen->photometry, albedo_);
    reading.tag = seen->tag;
    reading.plane = seen_plane(frame, row.camera_from_tag, seen->tag, camera_);
  }
  return reading;
}

}  // namespace catchlight::tracking
