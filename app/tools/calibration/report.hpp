// What a calibration tells its user: the camera file, figures, hints and a picture.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "app/tools/calibration/solve.hpp"

namespace catchlight::app {

/// Throws UsageError where camera_text() has no format for the name.
void check_camera_format(const std::string& path);

/// OpenCV FileStorage, as tracking::read_camera_file() and OpenCV's own tools read it: YAML, or JSON or XML where `path` ends so.
std::string camera_text(const Calibration& calibration, const std::string& path);

/// The same of a camera that was not calibrated with a board.
std::string camera_text(const CameraModel& camera, const std::string& path);

/// A line for each frame with its error and the board's tilt, then the camera's parameters with their standard deviations.
std::string calibration_text(const Calibration& calibration);

/// What to film for a better calibration, and which parameters these views do not determine; empty where nothing is amiss.
/// `most`: the model that was asked for.
std::vector<std::string> calibration_hints(const Calibration& calibration, LensModel most);

/// 8-bit BGR: every used corner with its residual magnified, in the frame's proportions; below it the error of every frame, with
/// rejected ones red.
cv::Mat calibration_picture(const Calibration& calibration);

}  // namespace catchlight::app
