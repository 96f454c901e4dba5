// Reads camera.yaml: OpenCV FileStorage as its calibration writes it, and ROS camera_info.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "catchlight/camera.hpp"

namespace catchlight::tracking {

/// Reads size, camera matrix, distortion and the optional key `vignetting: [v1, v2, v3]`. Throws Error naming the file and the
/// key for anything missing, malformed or not supported (e.g. fisheye models), and for vignetting that leaves nothing in a
/// corner.
CameraModel read_camera_file(const std::string& path);

/// A guess for footage of an unknown camera: principal point in the middle, square pixels, no distortion.
CameraModel camera_from_field_of_view(int width_px, int height_px, double horizontal_fov_deg);

}  // namespace catchlight::tracking
