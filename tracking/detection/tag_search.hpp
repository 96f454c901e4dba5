// Looks for a target's tags: near where they should be, or in the whole frame.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/luma_view.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"
#include "tracking/detection/detector.hpp"
#include "tracking/tracker_options.hpp"

namespace catchlight::tracking {

struct Sighting {
  std::size_t tag = 0;  ///< index into TagTarget::tags()
  Detection detection;
};

class TagSearch {
 public:
  /// Throws Error for an unknown family or an option out of range.
  TagSearch(const CameraModel& camera, const TagTarget& target, const TrackerOptions& options);

  /// Searches the part of the frame around a predicted pose; `reach_px` is how far off the prediction may be. Large tags are
  /// sought in a smaller picture.
  std::optional<Sighting> near(const LumaView& luma, const RigidTransform& camera_from_tag, double reach_px);

  /// Searches the whole frame, first in a smaller picture. With a prediction, a print that is both elsewhere and of another size
  /// is another copy of the tag (a thumbnail, a reflection): better to coast for a moment than to jump to it.
  std::optional<Sighting> anywhere(const LumaView& luma, const std::optional<RigidTransform>& predicted);

 private:
  std::vector<Sighting> sightings(const LumaView& luma, const PixelRect& region, double decimate);
  std::optional<Sighting> nearest(const std::vector<Sighting>& sightings, const RigidTransform& predicted) const;

  CameraModel camera_;
  std::vector<BundledTag> tags_;
  std::vector<std::pair<std::string, Detector>> detectors_;  ///< one a family
};

}  // namespace catchlight::tracking
