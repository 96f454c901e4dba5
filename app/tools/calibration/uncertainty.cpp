#include "app/tools/calibration/uncertainty.hpp"

#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

namespace catchlight::app {

std::vector<double> standard_deviations(const std::vector<SolvedView>& views, const cv::Mat& camera_matrix,
                                        const cv::Mat& distortion, int coefficients, double variance_px2) {
  constexpr int kPose = 6;  // projectPoints derives by rotation and translation, then fx, fy, cx, cy, then the coefficients
  const int parameters = 4 + coefficients;
  cv::Mat normal = cv::Mat::zeros(parameters, parameters, CV_64F);
  for (const SolvedView& view : views) {
    std::vector<cv::Point2d> ignored;
    cv::Mat jacobian, pose_inverse;
    cv::projectPoints(view.board_m, view.rotation, view.translation, camera_matrix, distortion, ignored, jacobian);
    const cv::Mat by_pose = jacobian.colRange(0, kPose), by_camera = jacobian.colRange(kPose, kPose + parameters);
    const cv::Mat mixed = by_camera.t() * by_pose;
    cv::invert(by_pose.t() * by_pose, pose_inverse, cv::DECOMP_SVD);
    normal += by_camera.t() * by_camera - mixed * pose_inverse * mixed.t();
  }
  // Pixels and coefficients differ by orders of magnitude: scaled to a unit diagonal before inverting.
  cv::Mat scale, inverse;
  cv::sqrt(normal.diag(), scale);
  const cv::Mat correlation = normal / (scale * scale.t());
  const bool is_regular = cv::invert(correlation, inverse, cv::DECOMP_CHOLESKY) != 0;
  std::vector<double> deviations;
  for (int i = 0; i < parameters; ++i) {
    const double value = is_regular ? std::sqrt(variance_px2 * inverse.at<double>(i, i)) / scale.at<double>(i) : NAN;
    deviations.push_back(std::isfinite(value) ? value : std::numeric_limits<double>::infinity());
  }
  return deviations;
}

}  // namespace catchlight::app
