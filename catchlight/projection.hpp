// How a camera sees points: OpenCV's pinhole camera with the rational distortion model, and its inverse.
// "Ideal" pixels are what the same camera without distortion would have seen: there, straight edges are straight.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "catchlight/camera.hpp"

namespace catchlight {

/// The distance from the axis up to which the rational model is one to one; beyond, it folds back into the picture. Functions
/// that are given a limit continue the model along a line there, so that every point is seen somewhere and nothing unseen folds
/// into the picture. Without one they take the model at its word.
struct DistortionLimit {
  double radius;     ///< in undistorted normalised coordinates: the model holds up to here
  double distorted;  ///< the radial part's value there
  double slope;      ///< the radial part's derivative there
};

/// The radius where the derivative falls under a tenth (a lens that squeezes more has no use for what is there), at most 20 (87
/// degrees off axis). It is searched for step by step: whoever holds a camera for long holds its limit too.
DistortionLimit distortion_limit(const CameraModel& camera);

/// The place at which an ideal pixel is seen.
glm::dvec2 distort_px(const CameraModel& camera, const glm::dvec2& ideal_px, const DistortionLimit* limit = nullptr);

/// The inverse of distort_px(), by Newton's method to 1e-9 px; empty where the model has none, which is beyond its field.
std::optional<glm::dvec2> undistort_px(const CameraModel& camera, const glm::dvec2& distorted_px,
                                       const DistortionLimit* limit = nullptr);

/// d distort_px / d ideal_px; columns: along x, along y.
glm::dmat2 distortion_jacobian(const CameraModel& camera, const glm::dvec2& ideal_px);

/// Pinhole projection without distortion; empty for points that are not in front of the camera.
std::optional<glm::dvec2> project_ideal_px(const CameraModel& camera, const glm::dvec3& point_camera_m);

/// Projection as seen, with distortion.
std::optional<glm::dvec2> project_px(const CameraModel& camera, const glm::dvec3& point_camera_m,
                                     const DistortionLimit* limit = nullptr);

/// (x, y, z) in the camera frame -> (z x', z y', z), x' and y' the distorted normalised coordinates; finite also for z <= 0.
glm::dvec3 distorted(const CameraModel& camera, const DistortionLimit& limit, const glm::dvec3& point_camera_m);

}  // namespace catchlight
