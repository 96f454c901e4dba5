// Which way a photograph looks: from a tag in it, or from angles given by hand.
#pragma once

#include <optional>
#include <string>

#include "catchlight/camera.hpp"
#include "catchlight/image.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/tag.hpp"

namespace catchlight::app {

struct TagSight {
  RigidTransform camera_from_tag;
  double corner_sigma_px = 0;
  double ambiguity = 0;  ///< probability that the other planar pose is the right one
};

/// The tag in a scene-linear picture. Its own light decides how it is exposed: several exposures are tried and the surest kept.
/// Empty where none shows it.
std::optional<TagSight> find_tag(const Image& radiance, const CameraModel& camera, const TagTarget& target);

/// What to say of a picture in which it is not found.
std::string instead_of_tag(const Image& radiance, const TagTarget& target);

/// The orientation of a camera without a tag: `yaw_deg` 0 is at probe +z, looking at -z, as in the mirror-ball layout; 90 at +x.
/// `pitch_deg` is how far the camera looks down. probe_from_camera.
glm::dmat3 probe_from_camera(double yaw_deg, double pitch_deg);

}  // namespace catchlight::app
