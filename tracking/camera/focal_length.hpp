// The focal length that a tag's own perspective shows.
#pragma once

#include <optional>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/luma_view.hpp"
#include "catchlight/tag.hpp"
#include "tracking/detection/detector.hpp"
#include "tracking/detection/families.hpp"
#include "tracking/pose/planar_pose.hpp"

namespace catchlight::tracking {

struct FocalEstimate {
  double fx_px = 0;
  double deviation_px = 0;  ///< standard deviation: noise, and what is not known of principal point and distortion
  int looks = 0;            ///< views of the tag that differ
};

/// A square that is seen tilted has two properties that only the right focal length explains (Zhang 2000): right angles and equal
/// sides. All else of the camera is taken as given, and the ratio fy/fx too.
class FocalMeter {
 public:
  /// Throws Error for a family or an id that does not exist.
  FocalMeter(const CameraModel& camera, const PrintedTag& tag);

  /// A frame and about where the tag's corners are: a pose by the wrong camera does not reach them, so that the tag is detected
  /// there anew. Views like earlier ones cost nothing.
  void add(const LumaView& luma, const Quad& corners_px);

  /// Empty where the tag's views are too few, too much alike or too frontal to tell the focal length to 5 %.
  std::optional<FocalEstimate> estimate() const;

 private:
  std::optional<Quad> detected(const LumaView& luma, const Quad& corners_px);
  bool is_new(const Quad& corners_px) const;
  void thin_out();

  CameraModel camera_;
  int id_;
  TagLayout layout_;
  Detector detector_;
  double min_step_;          ///< mean movement of the corners between looks, as a share of the tag's side
  std::vector<Quad> looks_;  ///< corners as seen
};

}  // namespace catchlight::tracking
