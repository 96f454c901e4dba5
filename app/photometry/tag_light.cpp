#include "app/photometry/tag_light.hpp"

#include "catchlight/pixel_rect.hpp"
#include "catchlight/plate.hpp"

namespace catchlight::app {
namespace {

TagTarget alone(const BundledTag& tag) {
  return {tag, {}};
}

}  // namespace

std::optional<TagLight::Reading> TagLight::read(const Frame& frame, const TrackRow& row) const {
  if (row.state != TrackState::tracking) return std::nullopt;
  const std::optional<Covariance2> blur_px2 = row.noise_codes > 0 ? std::optional(row.blur_px2) : std::nullopt;
  std::optional<Reading> clipped;
  for (const BundledTag& tag : target_.tags()) {
    const RigidTransform camera_from_this = row.camera_from_tag * tag.tag_from_this;
    const PixelRect region = tracking::photometry_region(camera_, camera_from_this, alone(tag));
    if (region.empty()) continue;
    const tracking::LinearPatch patch = tracking::linear_patch(frame.rgb(region), frame.color());
    const auto seen = tracking::measure_photometry(patch, camera_, camera_from_this, alone(tag), blur_px2);
    if (seen && !glm::any(seen->is_clipped)) return Reading{*seen, tag};
    if (seen && !clipped) clipped = Reading{*seen, tag};
  }
  return clipped;
}

tracking::PlaneLight TagLight::plane(const Frame& frame, const RigidTransform& camera_from_tag, const BundledTag& tag) const {
  const RigidTransform camera_from_this = camera_from_tag * tag.tag_from_this;
  const PixelRect region = tracking::plane_region(camera_, camera_from_this, alone(tag));
  if (region.empty()) return {};
  return tracking::measure_plane(tracking::linear_patch(frame.rgb(region), frame.color()), camera_, camera_from_this, alone(tag));
}

std::optional<std::string> exposure_warning(std::int64_t drawn, std::int64_t held, std::int64_t guessed) {
  if (held > 0)
    return "the exposure could not be read off the tag in " + std::to_string(held) + " of " + std::to_string(drawn) +
           " frames (covered, black or clipped) and is that of the frames around; where that shows, keep the tag in sight and "
           "its "
           "white below clipping";
  if (guessed > 0 && guessed == drawn)
    return "the tag's white is clipped in every frame; the exposure is estimated from its black, which flare spoils: expose the "
           "tag's white below clipping in one frame at least";
  return std::nullopt;
}

}  // namespace catchlight::app
