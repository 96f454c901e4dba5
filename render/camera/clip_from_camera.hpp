// The way from the camera frame to GL's clip space: the only place where OpenCV's camera meets GL.
#pragma once

#include <glm/glm.hpp>

#include "catchlight/pixel_rect.hpp"
#include "catchlight/projection.hpp"
#include "catchlight/rigid_transform.hpp"
#include "render/mesh/bounds.hpp"

namespace catchlight::render {

/// Takes homogeneous normalised coordinates (x, y, z, 1) (after distortion) to clip space: column c's pixel centre lands on
/// x_ndc = (c + 0.5) / width * 2 - 1, row r's on y_ndc = (r + 0.5) / height * 2 - 1, so framebuffers hold the top row first
/// and faces that wind counter-clockwise in the picture wind clockwise for GL. Depth is reversed (GL_ZERO_TO_ONE): near_m / z,
/// with no far plane.
glm::dmat4 clip_from_camera(const CameraModel& camera, double near_m);

/// Pixel rectangle within the picture that holds what lies in the box (tag frame): empty if all of it is nearer than near_m, the
/// whole picture if some of it is. Grown by a border that covers what distortion bends between samples.
PixelRect visible_rect(const CameraModel& camera, const DistortionLimit& limit, const RigidTransform& camera_from_tag,
                       const Bounds& box, double near_m);

}  // namespace catchlight::render
