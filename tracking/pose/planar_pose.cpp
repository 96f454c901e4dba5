#include "tracking/pose/planar_pose.hpp"

#include <algorithm>
#include <opencv2/calib3d.hpp>

#include "catchlight/projection.hpp"
#include "catchlight/tag.hpp"

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
double reprojection_rms_px(const CameraModel& camera, const RigidTransform& camera_from_tag, const Quad& corners_px,
                           double size_m) {
  const auto projected = project_corners(camera, camera_from_tag, size_m);
  if (!projected) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    const glm::dvec2 error = (*projected)[i] - corners_px[i];
    sum += glm::dot(error, error);
  }
  return std::sqrt(sum / 4);
}

bool shows_its_face(const RigidTransform& camera_from_tag) {
  return glm::dot(camera_from_tag.rotation[2], camera_from_tag.translation_m) < 0;
}

/// Seen frontally enough, both solutions lead to the one minimum there is.
bool same_pose(const RigidTransform& a, const RigidTransform& b) {
  constexpr double kSameAxis = 1e-3;  // axes of length 1: a twentieth of a degree
  return glm::distance(a.rotation[0], b.rotation[0]) < kSameAxis && glm::distance(a.rotation[1], b.rotation[1]) < kSameAxis;
}

/// OpenCV's IPPE returns rotation vectors, and breaks down where they are half a turn: as for every tag held upright, whose
/// y points up and z at the camera. So it is given the square in a frame that is nearly the camera's, y down and z into
/// the print, and turned about its normal until its first edge points right in the image.
int quarter_turns_to_upright(const Quad& ideal_px) {
  int best = 0;
  for (int i = 1; i < 4; ++i)
    if (ideal_px[(i + 1) % 4].x - ideal_px[i].x > ideal_px[(best + 1) % 4].x - ideal_px[best].x) best = i;
  return best;
}

/// The rotation from that frame back to the tag's: half a turn about x, then quarter turns about z.
glm::dmat3 tag_from_upright(int turns) {
  constexpr int kCos[] = {1, 0, -1, 0}, kSin[] = {0, 1, 0, -1};
  const glm::dmat3 quarter_turns{{kCos[turns], kSin[turns], 0}, {-kSin[turns], kCos[turns], 0}, {0, 0, 1}};
  const glm::dmat3 half_turn{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  return quarter_turns * half_turn;
}

}  // namespace

std::optional<Quad> project_corners(const CameraModel& camera, const RigidTransform& camera_from_tag, double size_m) {
  Quad quad;
  const auto corners_m = tag_corners_m(size_m);
  for (int i = 0; i < 4; ++i) {
    const auto corner = project_px(camera, camera_from_tag * corners_m[i]);
    if (!corner || !std::isfinite(corner->x + corner->y)) return std::nullopt;
    quad[i] = *corner;
  }
  return quad;
}

std::vector<PoseHypothesis> planar_poses(const CameraModel& camera, const Quad& corners_px, double size_m) {
  Quad ideal_px;
  for (int i = 0; i < 4; ++i) {
    const auto ideal = undistort_px(camera, corners_px[i]);
    if (!ideal || !std::isfinite(ideal->x + ideal->y)) return {};
    ideal_px[i] = *ideal;
  }
  const cv::Matx33d intrinsics(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  const int turns = quarter_turns_to_upright(ideal_px);
  const double h = size_m / 2;
  const std::vector<cv::Point3d> object_m{{-h, h, 0}, {h, h, 0}, {h, -h, 0}, {-h, -h, 0}};  // what IPPE_SQUARE asks for
  std::vector<cv::Point2d> image_px;
  for (int i = 0; i < 4; ++i) image_px.emplace_back(ideal_px[(i + turns) % 4].x, ideal_px[(i + turns) % 4].y);
  std::vector<cv::Mat> rotations, translations;
  cv::solvePnPGeneric(object_m, image_px, intrinsics, cv::noArray(), rotations, translations, false, cv::SOLVEPNP_IPPE_SQUARE);

  std::vector<PoseHypothesis> poses;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    if (!cv::checkRange(rotations[i]) || !cv::checkRange(translations[i])) continue;
    const cv::TermCriteria until(cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 50, 1e-12);
    cv::solvePnPRefineLM(object_m, image_px, intrinsics, cv::noArray(), rotations[i], translations[i], until);
    RigidTransform pose = rigid_transform(rotations[i], translations[i]);
    pose.rotation = pose.rotation * glm::transpose(tag_from_upright(turns));
    const double rms_px = reprojection_rms_px(camera, pose, corners_px, size_m);
    if (std::isfinite(rms_px) && shows_its_face(pose)) poses.push_back({pose, rms_px});
  }
  std::stable_sort(poses.begin(), poses.end(),
                   [](const auto& a, const auto& b) { return a.reprojection_rms_px < b.reprojection_rms_px; });
  if (poses.size() == 2 && same_pose(poses[0].camera_from_tag, poses[1].camera_from_tag)) poses.pop_back();
  return poses;
}

}  // namespace catchlight::tracking
