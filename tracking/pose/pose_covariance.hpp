// How uncertain a pose's corners are in the picture, and how uncertain a pose is that was made of corners.
#pragma once

#include <array>

#include "catchlight/camera.hpp"
#include "catchlight/rigid_transform.hpp"
#include "tracking/observation.hpp"

namespace catchlight::tracking {

/// Root mean square standard deviation, per axis, of the corners of a tag in the picture.
double corner_sigma_px(const CameraModel& camera, const RigidTransform& camera_from_tag, const PoseCovariance& covariance,
                       double size_m);

/// Covariance of a pose that is fitted to four corners of independent errors of `sigma_px` per axis.
PoseCovariance covariance_from_corners(const CameraModel& camera, const RigidTransform& camera_from_tag, double size_m,
                                       double sigma_px);

}  // namespace catchlight::tracking
