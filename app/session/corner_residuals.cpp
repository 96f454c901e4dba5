#include "app/session/corner_residuals.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/tag.hpp"
#include "tracking/detection/detector.hpp"
#include "tracking/detection/families.hpp"
#include "tracking/pose/planar_pose.hpp"
#include "tracking/refinement/corner_refinement.hpp"

namespace catchlight::app {

std::vector<CornerResiduals> corner_residuals(const Frame& frame, const TrackRow& row, const CameraModel& camera,
                                              const SceneSettings& scene) {
  std::vector<CornerResiduals> residuals;
  if (!row.found) return residuals;
  const std::vector<BundledTag> tags = scene.tag.target().tags();
  std::vector<std::string> families;
  for (const BundledTag& tag : tags)
    if (!std::ranges::count(families, tag.family)) families.push_back(tag.family);
  const LumaView luma = frame.luma();
  for (const tracking::Detection& seen : tracking::Detector(families, scene.tag.tracker_options()).detect(luma)) {
    const auto tag = std::ranges::find_if(
        tags, [&](const BundledTag& known) { return known.id == seen.id && known.family == families[seen.family]; });
    if (tag == tags.end()) continue;
    const auto drawn_px = tracking::project_corners(camera, row.camera_from_tag * tag->tag_from_this, tag->size_m);
    if (!drawn_px) continue;
    const tracking::TagLayout layout = tracking::tag_layout(tag->family, tag->id);
    residuals.push_back({tag->id, *drawn_px, tracking::refine_corners(luma, camera, seen.corners_px, layout).corners_px});
  }
  return residuals;
}

double rms_px(const std::vector<CornerResiduals>& residuals) {
  double squares = 0;
  for (const CornerResiduals& tag : residuals)
    for (std::size_t i = 0; i < 4; ++i) {
      const glm::dvec2 error_px = tag.seen_px[i] - tag.drawn_px[i];
      squares += glm::dot(error_px, error_px);
    }
  return residuals.empty() ? 0 : std::sqrt(squares / static_cast<double>(4 * residuals.size()));
}

}  // namespace catchlight::app
