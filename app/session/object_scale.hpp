// How large the objects come out in the footage, so that a model in other units is noticed.
#pragma once

#include <optional>
#include <string>

#include "catchlight/camera.hpp"
#include "catchlight/rigid_transform.hpp"
#include "render/mesh/bounds.hpp"

namespace catchlight::app {

/// "object 98 × 74 × 83 mm on a tag of 140 mm, 0.72 m away". The box is in the scene frame.
std::string scale_text(const render::Bounds& box, double tag_size_m, const RigidTransform& camera_from_scene);

/// What is odd about the size, if anything: the camera is inside the box, or the object is smaller than a pixel, or far larger
/// than the frame.
std::optional<std::string> scale_warning(const render::Bounds& box, const CameraModel& camera,
                                         const RigidTransform& camera_from_scene);

}  // namespace catchlight::app
