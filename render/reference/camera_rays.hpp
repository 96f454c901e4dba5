// Rays through a camera's pixels and back, lens distortion included.
#pragma once

#include <optional>

#include "catchlight/projection.hpp"
#include "catchlight/rigid_transform.hpp"

namespace catchlight::render::reference {

class CameraRays {
 public:
  CameraRays(const CameraModel& camera, const RigidTransform& camera_from_tag);

  const glm::dvec3& origin_tag_m() const { return origin_tag_m_; }

  /// Unit direction (tag frame) of what is seen at `pixel`.
  glm::dvec3 direction_tag(const glm::dvec2& pixel) const;

  /// Where the camera sees the point; empty where it is not in front of it.
  std::optional<glm::dvec2> pixel_of(const glm::dvec3& point_tag_m) const;

 private:
  CameraModel camera_;
  DistortionLimit limit_;
  RigidTransform camera_from_tag_;
  glm::dvec3 origin_tag_m_;
};

}  // namespace catchlight::render::reference
