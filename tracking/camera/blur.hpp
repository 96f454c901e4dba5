// Takes the blur of the tag's edges apart: what the focus does, and what the shutter does while the tag moves.
#pragma once

#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/track.hpp"

namespace catchlight::tracking {

/// Mean over the tag of v v^T / 12, v the way (pixels) its points go from frame to frame: the covariance that a shutter open all
/// the time would add.
Covariance2 motion_covariance(const CameraModel& camera, const RigidTransform& camera_from_tag, const TagMotion& motion,
                              double tag_size_m);

/// Fills in `blur` of rows in order, from their poses and blur.
/// Motion: half the way from the frame before to the frame after, or all of it from one of them.
/// Shutter: the blur is focus * I + shutter^2 * motion's covariance, so its two parts that have a direction, xx - yy and 2 xy,
/// are shutter^2 times motion's, whatever the focus: least squares over all rows, those that do not fit weighted down (Huber).
/// 0 where that is not four times its own standard error.
/// Focus: what then is left, the mean of both axes; the median of seven frames.
/// A frame whose blur is certainly another (the camera was jerked) has its own: it is the focus along which it is sharpest, and
/// the line that explains the rest, as a turn of the camera beyond shutter and motion. Certainly: beyond five times what frames
/// are off as a rule, growing from nothing there, so that what is measured of still frames does not make them flicker.
void measure_blur(std::vector<TrackRow>& rows, const CameraModel& camera, double tag_size_m);

/// A frame's measured blur less what focus, shutter and motion say of it.
struct BlurExcess {
  double even = 0;           ///< the mean of both axes
  glm::dvec2 directed{0.0};  ///< half of xx - yy, and xy
};

/// The same of live footage: each row by those before it.
class BlurMeter {
 public:
  BlurMeter(const CameraModel& camera, double tag_size_m) : camera_(camera), tag_size_m_(tag_size_m) {}

  void add(TrackRow& row);

 private:
  CameraModel camera_;
  double tag_size_m_;
  std::vector<TrackRow> last_;
  std::vector<Covariance2> motions_;  ///< one for each of those rows
  std::vector<BlurExcess> excesses_;  ///< of those that were measured
};

}  // namespace catchlight::tracking
