// OpenCV's pinhole camera with the rational distortion model, exact in both directions.
// "Ideal" pixels are what the same camera without distortion would have seen: there, straight edges are straight.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "catchlight/camera.hpp"

namespace catchlight::tracking {

/// Where the lens puts an ideal pixel.
glm::dvec2 distort_px(const CameraModel& camera, const glm::dvec2& ideal_px);

/// The inverse, by Newton's method to 1e-9 px; empty where the model has none (outside the lens's field).
std::optional<glm::dvec2> undistort_px(const CameraModel& camera, const glm::dvec2& distorted_px);

/// d distort_px / d ideal_px; columns: along x, along y.
glm::dmat2 distortion_jacobian(const CameraModel& camera, const glm::dvec2& ideal_px);

/// Pinhole projection without distortion; empty for points that are not in front of the camera.
std::optional<glm::dvec2> project_ideal_px(const CameraModel& camera, const glm::dvec3& point_camera_m);

/// Projection as seen, with distortion.
std::optional<glm::dvec2> project_px(const CameraModel& camera, const glm::dvec3& point_camera_m);

}  // namespace catchlight::tracking
