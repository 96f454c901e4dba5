#include "tracking/camera/exposure_reading.hpp"

#include <algorithm>

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

std::optional<SeenTag> seen_tag(const PixelLight& light, const TrackRow& row, const CameraModel& camera,
                                const TagTarget& target) {
  if (row.state != TrackState::tracking) return std::nullopt;
  const std::optional<Covariance2> blur_px2 = row.noise_codes > 0 ? std::optional(row.blur_px2) : std::nullopt;
  std::optional<SeenTag> clipped;
  for (const BundledTag& tag : target.tags()) {
    const RigidTransform camera_from_this = row.camera_from_tag * tag.tag_from_this;
    if (photometry_region(camera, camera_from_this, alone(tag)).empty()) continue;
    const auto seen = measure_photometry(light, camera, camera_from_this, alone(tag), blur_px2);
    if (seen && !glm::any(seen->is_clipped)) return SeenTag{*seen, tag};
    if (seen && !clipped) clipped = SeenTag{*seen, tag};
  }
  return clipped;
}

}  // namespace

bool ExposureReading::is_guessed() const {
  return std::find(own.sources.begin(), own.sources.end(), ExposureSource::black) != own.sources.end();
}

ExposureReading ExposureReader::read(const FrameImage& frame, const TrackRow& row) const {
  ExposureReading reading;
  reading.time_s = row.time_s;
  const PixelLight light = pixel_light(frame);
  if (const auto seen = seen_tag(light, row, camera_, target_)) {
    reading.own = read_exposure(seen->photometry, albedo_);
    reading.tag = seen->tag;
    reading.plane = measure_plane(light, camera_, row.camera_from_tag * seen->tag.tag_from_this, alone(seen->tag));
  }
  return reading;
}

}  // namespace catchlight::tracking
