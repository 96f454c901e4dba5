// The light of places on the tag's plane, to compare the exposures of two frames where the tag's own white is clipped.
#pragma once

#include <optional>
#include <vector>

#include "catchlight/camera.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"
#include "tracking/camera/photometry.hpp"

namespace catchlight::tracking {

/// Mean linear RGB of places that keep their order from frame to frame: the cells of the tag, and patches of half a tag's side
/// around it, to two and a half sides from its centre. NaN in a channel: clipped there, or not wholly in the picture.
struct PlaneLight {
  std::vector<glm::vec3> linear;
  std::vector<float> samples;  ///< a number for each place: what its mean is worth
};

PlaneLight measure_plane(const PixelLight& light, const CameraModel& camera, const RigidTransform& camera_from_tag,
                         const TagTarget& target);

/// The factor by which a channel became brighter: the mean of the places' ratios, weighted by what the noise of light leaves of
/// them (their samples times their light), without the quarter of the weight at either end: what moved, shines, or stands on the
/// plane. Where the ratios of that half differ by more than 5 %, the surroundings are not one surface with the tag (a tag in the
/// hand), and its own cells alone count. Empty where fewer than eight places are known in both.
std::optional<double> brightening(const PlaneLight& now, const PlaneLight& then, int channel);

}  // namespace catchlight::tracking
