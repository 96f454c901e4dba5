// Reads camera.yaml: OpenCV FileStorage as its calibration writes it, and ROS camera_info.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "catchlight/camera.hpp"

namespace catchlight::tracking {

/// Throws Error naming the file and the key for anything missing, malformed or not supported (e.g. fisheye models).
CameraModel read_camera_file(const std::string& path);

/// v1, v2, v3 of the optional key `vignetting: [v1, v2, v3]`: r half diagonals from the principal point the lens passes
/// 1 + v1 r^2 + v2 r^4 + v3 r^6 of the light. All 0 without it. Throws Error as above, and where nothing would be left in a
/// corner.
glm::dvec3 read_vignetting(const std::string& path);

/// A guess for footage of an unknown camera: principal point in the middle, square pixels, no distortion.
CameraModel camera_from_field_of_view(int width_px, int height_px, double horizontal_fov_deg);

}  // namespace catchlight::tracking
