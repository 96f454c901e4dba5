#include "tracking/planar_pose.hpp"

#include <algorithm>
#include <opencv2/calib3d.hpp>

#include "tracking/lens.hpp"

namespace catchlight::tracking {
namespace {

RigidTransform rigid_transform(const cv::Mat& rotation_vector, const cv::Mat& translation) {
  cv::Matx33d rotation;
  cv::Rodrigues(rotation_vector, rotation);
  RigidTransform result;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) result.rotation[column][row] = rotation(row, column);
    result.translation_m[row] = translation.at<double>(row);
  }
  return result;
}

/// Infinite where a corner is behind the camera.
double reprojection_rms_px(const CameraModel& camera, const RigidTransform& camera_from_tag,
                           const std::array<glm::dvec2, 4>& corners_px, double size_m) {
  double sum = 0;
  const auto corners_m = tag_corners_m(size_m);
  for (int i = 0; i < 4; ++i) {
    const auto projected = project_px(camera, camera_from_tag * corners_m[i]);
    if (!projected) return std::numeric_limits<double>::infinity();
    const glm::dvec2 error = *projected - corners_px[i];
    sum += glm::dot(error, error);
  }
  return std::sqrt(sum / 4);
}

bool shows_its_face(const RigidTransform& camera_from_tag) {
  return glm::dot(camera_from_tag.rotation[2], camera_from_tag.translation_m) < 0;
}

}  // namespace

std::array<glm::dvec3, 4> tag_corners_m(double size_m) {
  const double h = size_m / 2;
  return {{{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}}};
}

std::vector<PoseHypothesis> planar_poses(const CameraModel& camera, const std::array<glm::dvec2, 4>& corners_px, double size_m) {
  const cv::Matx33d intrinsics(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  const auto corners_m = tag_corners_m(size_m);
  // OpenCV wants the corners of IPPE_SQUARE from the top left on, clockwise as the tag is read.
  std::vector<cv::Point3d> object_m;
  std::vector<cv::Point2d> ideal_px;
  for (const int i : {3, 2, 1, 0}) {
    const auto ideal = undistort_px(camera, corners_px[i]);
    if (!ideal || !std::isfinite(ideal->x + ideal->y)) return {};
    object_m.emplace_back(corners_m[i].x, corners_m[i].y, corners_m[i].z);
    ideal_px.emplace_back(ideal->x, ideal->y);
  }
  std::vector<cv::Mat> rotations, translations;
  cv::solvePnPGeneric(object_m, ideal_px, intrinsics, cv::noArray(), rotations, translations, false, cv::SOLVEPNP_IPPE_SQUARE);

  std::vector<PoseHypothesis> poses;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    if (!cv::checkRange(rotations[i]) || !cv::checkRange(translations[i])) continue;
    const cv::TermCriteria until(cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 50, 1e-12);
    cv::solvePnPRefineLM(object_m, ideal_px, intrinsics, cv::noArray(), rotations[i], translations[i], until);
    const RigidTransform pose = rigid_transform(rotations[i], translations[i]);
    const double rms_px = reprojection_rms_px(camera, pose, corners_px, size_m);
    if (std::isfinite(rms_px) && shows_its_face(pose)) poses.push_back({pose, rms_px});
  }
  std::stable_sort(poses.begin(), poses.end(),
                   [](const auto& a, const auto& b) { return a.reprojection_rms_px < b.reprojection_rms_px; });
  return poses;
}

}  // namespace catchlight::tracking
