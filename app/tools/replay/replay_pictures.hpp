// The pictures that replay compares: 8-bit BGR, whatever the footage is.
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "app/media/pixels/frame.hpp"
#include "app/session/frame_job.hpp"

namespace catchlight::app {

cv::Mat bgr_of(const Frame& frame);

/// The frame as overlay would write it.
cv::Mat composited_bgr(const FrameJob& job);

/// Throws Error where the file cannot be read or has another size.
cv::Mat read_bgr(const std::string& path, const cv::Size& size);

}  // namespace catchlight::app
