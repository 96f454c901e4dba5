// How far noise may have moved a solved camera.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace catchlight::app {

struct SolvedView {
  std::vector<cv::Point3d> board_m;
  cv::Mat rotation, translation;  ///< as OpenCV gives them: rotation vector, metres
};

/// Standard deviations of fx, fy, cx, cy and the first `coefficients` of distortion, the poses being unknown too: the inverse of
/// the poses' Schur complement in the normal equations (Triggs et al., "Bundle adjustment", 2000, section 6.1), times
/// `variance_px2` of one coordinate of one corner. Infinite where the views do not determine them.
std::vector<double> standard_deviations(const std::vector<SolvedView>& views, const cv::Mat& camera_matrix,
                                        const cv::Mat& distortion, int coefficients, double variance_px2);

}  // namespace catchlight::app
