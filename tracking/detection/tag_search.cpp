#include "tracking/detection/tag_search.hpp"

#include <algorithm>
#include <cmath>

#include "tracking/pose/planar_pose.hpp"

namespace catchlight::tracking {
namespace {

constexpr double kDecimate = 2;
constexpr double kDecimatedSidePx = 80;  ///< tags at least this large are found as surely in half the resolution

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

/// The sighting to take without a prediction: the one with the fewest corrected bits, then the larger.
std::optional<Sighting> most_trusted(const std::vector<Sighting>& sightings) {
  const auto worse = [](const Sighting& a, const Sighting& b) {
    if (a.detection.hamming != b.detection.hamming) return a.detection.hamming > b.detection.hamming;
    return side_px(a.detection.corners_px) < side_px(b.detection.corners_px);
  };
  const auto best = std::max_element(sightings.begin(), sightings.end(), worse);
  return best == sightings.end() ? std::nullopt : std::optional(*best);
}

/// Part of a frame.
LumaView cropped(const LumaView& luma, const PixelRect& region) {
  LumaView part = luma;
  part.data += static_cast<std::ptrdiff_t>(region.y) * luma.stride + region.x;
  part.width_px = region.width;
  part.height_px = region.height;
  return part;
}

}  // namespace

TagSearch::TagSearch(const CameraModel& camera, const TagTarget& target, const TrackerOptions& options)
    : camera_(camera), tags_(target.tags()) {
  for (const BundledTag& tag : tags_) {
    const auto same = [&](const auto& entry) { return entry.first == tag.family; };
    if (std::none_of(detectors_.begin(), detectors_.end(), same))
      detectors_.emplace_back(tag.family, Detector(tag.family, options));
  }
}

std::vector<Sighting> TagSearch::sightings(const LumaView& luma, const PixelRect& region, double decimate) {
  std::vector<Sighting> found;
  for (auto& [family, detector] : detectors_)
    for (Detection& detection : detector.detect(cropped(luma, region), decimate)) {
      for (glm::dvec2& corner : detection.corners_px) corner += glm::dvec2(region.x, region.y);
      for (std::size_t i = 0; i < tags_.size(); ++i)
        if (tags_[i].family == family && tags_[i].id == detection.id) found.push_back({i, detection});
    }
  return found;
}

std::optional<Sighting> TagSearch::nearest(const std::vector<Sighting>& sightings, const RigidTransform& predicted) const {
  std::optional<Sighting> best;
  double best_distance = 0, best_side = 0;
  for (const Sighting& sighting : sightings) {
    const BundledTag& tag = tags_[sighting.tag];
    const auto expected = project_corners(camera_, predicted * tag.tag_from_this, tag.size_m);
    if (!expected) continue;
    const double distance = glm::distance(center(sighting.detection.corners_px), center(*expected));
    if (best && distance >= best_distance) continue;
    best = sighting;
    best_distance = distance;
    best_side = side_px(*expected);
  }
  if (!best) return std::nullopt;
  const double ratio = side_px(best->detection.corners_px) / best_side;
  const bool elsewhere = best_distance > 1.5 * best_side, other_size = std::max(ratio, 1 / ratio) > 1.5;
  return elsewhere && other_size ? std::nullopt : best;
}

std::optional<Sighting> TagSearch::near(const LumaView& luma, const RigidTransform& camera_from_tag, double reach_px) {
  glm::dvec2 low(1e9), high(-1e9);
  double smallest_px = 1e9;
  for (const BundledTag& tag : tags_) {
    const auto quad = project_corners(camera_, camera_from_tag * tag.tag_from_this, tag.size_m);
    if (!quad) return std::nullopt;
    const double side = side_px(*quad);
    smallest_px = std::min(smallest_px, side);
    for (const glm::dvec2& corner : *quad) {
      low = glm::min(low, corner - side / 2 - reach_px);
      high = glm::max(high, corner + side / 2 + reach_px);
    }
  }
  const glm::dvec2 image(luma.width_px, luma.height_px);
  const glm::ivec2 from(glm::clamp(low, glm::dvec2(0), image)), to(glm::clamp(high, glm::dvec2(0), image));
  const PixelRect region{from.x, from.y, to.x - from.x, to.y - from.y};
  if (region.empty()) return std::nullopt;
  return nearest(sightings(luma, region, smallest_px >= kDecimatedSidePx ? kDecimate : 1), camera_from_tag);
}

std::optional<Sighting> TagSearch::anywhere(const LumaView& luma, const std::optional<RigidTransform>& predicted) {
  const PixelRect all{0, 0, luma.width_px, luma.height_px};
  for (const double decimate : {2 * kDecimate, kDecimate, 1.0}) {
    const std::vector<Sighting> found = sightings(luma, all, decimate);
    if (const auto chosen = predicted ? nearest(found, *predicted) : most_trusted(found)) return chosen;
  }
  return std::nullopt;
}

}  // namespace catchlight::tracking
