#include "tracking/pose/pose_covariance.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "catchlight/tag.hpp"

namespace catchlight::tracking {
namespace {

using Jacobian = cv::Matx<double, 2, 6>;

/// d ideal pixel / d (rotation about the tag's origin, translation).
Jacobian projection_jacobian(const CameraModel& camera, const RigidTransform& camera_from_tag, const glm::dvec3& point_tag_m) {
  const glm::dvec3 arm_m = camera_from_tag.rotation * point_tag_m, p = arm_m + camera_from_tag.translation_m;
  const glm::dvec3 rows[2] = {glm::dvec3(1, 0, -p.x / p.z) * (camera.fx_px / p.z),
                              glm::dvec3(0, 1, -p.y / p.z) * (camera.fy_px / p.z)};
  Jacobian jacobian;
  for (int row = 0; row < 2; ++row) {
    const glm::dvec3 by_turn = glm::cross(arm_m, rows[row]);
    for (int i = 0; i < 3; ++i) {
      jacobian(row, i) = by_turn[i];
      jacobian(row, 3 + i) = rows[row][i];
    }
  }
  return jacobian;
}

}  // namespace

double corner_sigma_px(const CameraModel& camera, const RigidTransform& camera_from_tag, const PoseCovariance& covariance,
                       double size_m) {
  const cv::Matx66d spread(covariance.data());
  double variance_px2 = 0;
  for (const glm::dvec3& corner_m : tag_corners_m(size_m)) {
    const Jacobian jacobian = projection_jacobian(camera, camera_from_tag, corner_m);
    variance_px2 += cv::trace(jacobian * spread * jacobian.t()) / 8;
  }
  return std::sqrt(std::max(variance_px2, 0.0));
}

PoseCovariance covariance_from_corners(const CameraModel& camera, const RigidTransform& camera_from_tag, double size_m,
                                       double sigma_px) {
  cv::Matx66d information = cv::Matx66d::zeros();
  for (const glm::dvec3& corner_m : tag_corners_m(size_m)) {
    const Jacobian jacobian = projection_jacobian(camera, camera_from_tag, corner_m);
    information += jacobian.t() * jacobian * (1 / (sigma_px * sigma_px));
  }
  const cv::Matx66d spread = information.inv(cv::DECOMP_SVD);
  PoseCovariance covariance;
  std::copy(spread.val, spread.val + 36, covariance.begin());
  return covariance;
}

}  // namespace catchlight::tracking
