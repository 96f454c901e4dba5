// From the camera frame to GL's clip space, lens distortion included. The only place where OpenCV's camera meets GL.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "catchlight/camera.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/rigid_transform.hpp"
#include "render/mesh/bounds.hpp"

namespace catchlight::render {

/// Takes homogeneous normalised coordinates (x, y, z, 1) (after distortion) to clip space: column c's pixel centre lands on
/// x_ndc = (c + 0.5) / width * 2 - 1, row r's on y_ndc = (r + 0.5) / height * 2 - 1, so framebuffers hold the top row first
/// and faces that wind counter-clockwise in the picture wind clockwise for GL. Depth is reversed (GL_ZERO_TO_ONE): near_m / z,
/// with no far plane.
glm::dmat4 clip_from_camera(const CameraModel& camera, double near_m);

/// OpenCV's rational model x (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6) + tangential terms folds back far
/// from the axis. Beyond `radius` (of undistorted normalised coordinates) it is continued along a line, so that nothing unseen
/// folds into the picture.
struct LensLimit {
  double radius;     ///< the model holds up to here
  double distorted;  ///< the radial part's value there
  double slope;      ///< and its derivative
};

/// The radius where the derivative falls under a tenth (a lens that squeezes more has no use for what is there), at most 20 (87
/// degrees off axis).
LensLimit lens_limit(const CameraModel& camera);

/// (x, y, z) in the camera frame -> (z x', z y', z), x' and y' the distorted normalised coordinates; finite also for z <= 0.
glm::dvec3 distorted(const CameraModel& camera, const LensLimit& limit, const glm::dvec3& point_camera_m);

/// Pixel rectangle within the picture that holds what lies in the box (tag frame) can cover: empty if all of it is nearer
/// than near_m, the whole picture if some of it is. Grown by a border that covers what the lens bends between samples.
PixelRect visible_rect(const CameraModel& camera, const RigidTransform& camera_from_tag, const Bounds& box, double near_m);

}  // namespace catchlight::render
