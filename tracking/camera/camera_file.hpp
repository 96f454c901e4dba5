// Reads camera files: OpenCV's own (YAML, JSON, XML), ROS camera_info, Kalibr, and what Python programs write of OpenCV's
// results.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"

namespace catchlight::tracking {

/// Reads size, camera matrix, distortion and the optional key `vignetting: [v1, v2, v3]`; the size is 0x0 where the file says
/// none. Throws Error naming the file and the key for anything missing, malformed or not supported (e.g. fisheye models), and for
/// vignetting that leaves nothing in a corner.
CameraModel read_camera_file(const std::string& path);

/// The file's camera for pictures of this size. One for pictures of another size and the same aspect is scaled, and a file
/// without a size is taken for one of this size where its principal point lies near the middle; either is warned of. `pictures`
/// names them in messages. Throws Error as read_camera_file(), and where the aspects differ.
CameraModel read_camera_file_for(const std::string& path, const std::string& pictures, int width_px, int height_px,
                                 const WarningHandler& warn);

/// A guess for footage of an unknown camera: principal point in the middle, square pixels, no distortion.
CameraModel camera_from_field_of_view(int width_px, int height_px, double horizontal_fov_deg);

/// The inverse: from edge to edge of the picture.
double horizontal_fov_deg(const CameraModel& camera);

}  // namespace catchlight::tracking
