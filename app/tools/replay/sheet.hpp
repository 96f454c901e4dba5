// Pictures to look at: what was measured, side by side.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace catchlight::app {

/// One row of the sheet: plate | ours | truth | difference x 8. All 8-bit BGR of one size.
cv::Mat sheet_row(const cv::Mat& plate, const cv::Mat& ours, const cv::Mat& truth);

/// Writes rows below each other as PNG. Throws Error where that cannot be done.
void write_sheet(const std::string& path, const std::vector<cv::Mat>& rows);

}  // namespace catchlight::app
