// Covariances against what happens: corners are disturbed, poses refitted, and their spread is compared.
#include "tracking/pose/pose_covariance.hpp"
#include "catchlight/error.hpp"
#include "catchlight/rigid_transform.hpp"
#include "catchlight/rotation.hpp"
#include "tests/support/pose_error.hpp"
#include "tests/support/synthetic_tag.hpp"
#include "tracking/observation.hpp"
#include "tracking/pose/planar_pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <random>

namespace catchlight::tracking {
namespace {

constexpr double kSize_m = 0.08;

using Error = cv::Matx<double, 6, 1>;

/// Error of a refitted pose: a turn about the camera's axes through the tag's origin, then a shift.
Error error_of(const RigidTransform& fitted, const RigidTransform& truth) {
  const glm::dvec3 turn = rotation_vector(fitted.rotation * glm::transpose(truth.rotation));
  const glm::dvec3 shift = fitted.translation_m - truth.translation_m;
  return {turn.x, turn.y, turn.z, shift.x, shift.y, shift.z};
}

/// The fit nearer to the truth, of corners with errors of `sigma_px` per axis.
RigidTransform refitted(const RigidTransform& truth, double sigma_px, std::mt19937& random) {
  std::normal_distribution<double> normal;
  auto corners_px = true_corners_px(plain_camera(), {{{"tag36h11", 0, kSize_m}, {}}, truth});
  for (glm::dvec2& corner : corners_px) corner += sigma_px * glm::dvec2(normal(random), normal(random));
  const auto poses = planar_poses(plain_camera(), corners_px, kSize_m);
  const bool second =
      poses.size() == 2 && turn_between_deg(poses[1].camera_from_tag, truth) < turn_between_deg(poses[0].camera_from_tag, truth);
  return poses.at(second ? 1 : 0).camera_from_tag;
}

/// The lower triangle L with L Lᵗ = covariance.
cv::Matx66d cholesky(const cv::Matx66d& covariance) {
  cv::Matx66d lower = cv::Matx66d::zeros();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j) {
      double rest = covariance(i, j);
      for (int k = 0; k < j; ++k) rest -= lower(i, k) * lower(j, k);
      lower(i, j) = i == j ? std::sqrt(rest) : rest / lower(j, j);
    }
  return lower;
}

class PoseCovarianceOf : public ::testing::TestWithParam<glm::dvec3> {};

TEST_P(PoseCovarianceOf, IsTheSpreadOfRefittedPoses) {
  const RigidTransform truth = tag_pose(plain_camera(), {400, 180}, 0.4, GetParam());
  constexpr double kSigma_px = 0.02;
  constexpr int kTrials = 500;
  std::mt19937 random(11);
  const cv::Matx66d predicted(covariance_from_corners(plain_camera(), truth, kSize_m, kSigma_px).data());
  cv::Matx66d spread = cv::Matx66d::zeros();
  const cv::Matx66d whiten = cholesky(predicted).inv();  // makes errors unit and independent
  for (int trial = 0; trial < kTrials; ++trial) {
    const Error unit = whiten * error_of(refitted(truth, kSigma_px, random), truth);
    spread += unit * unit.t() * (1.0 / kTrials);
  }
  // A variance from n samples is off by sqrt(2/n), a covariance by sqrt(1/n); four and a half times that for 21 of them.
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j)
      EXPECT_NEAR(spread(i, j), i == j, 4.5 * std::sqrt((i == j ? 2.0 : 1.0) / kTrials)) << i << ", " << j;
}

INSTANTIATE_TEST_SUITE_P(Tilts, PoseCovarianceOf,
                         ::testing::Values(glm::dvec3(35, 0, 0), glm::dvec3(-20, 45, 130), glm::dvec3(0, -65, 10)));

TEST(PoseCovariance, FourCornersFittedBySixNumbersKeepThreeQuartersOfTheirVariance) {
  // trace(J (JᵗJ)⁻¹ Jᵗ) = 6 of 8 coordinates, whatever the pose.
  for (const glm::dvec3 turn_deg : {glm::dvec3(35, 0, 0), glm::dvec3(-20, 45, 130), glm::dvec3(3, 2, 0)}) {
    const RigidTransform pose = tag_pose(plain_camera(), {400, 180}, 0.4, turn_deg);
    const PoseCovariance covariance = covariance_from_corners(plain_camera(), pose, kSize_m, 0.03);
    EXPECT_NEAR(corner_sigma_px(plain_camera(), pose, covariance, kSize_m), 0.03 * std::sqrt(0.75), 1e-8);
  }
}

TEST(PoseCovariance, AShiftAcrossTheViewMovesCornersByFocalLengthOverDepth) {
  const RigidTransform facing = tag_pose(plain_camera(), {319.5, 239.5}, 0.5, {0, 0, 0});
  PoseCovariance covariance{};
  covariance[6 * 3 + 3] = 1e-6;  // 1 mm along x
  EXPECT_NEAR(corner_sigma_px(plain_camera(), facing, covariance, kSize_m), 600 * 1e-3 / 0.5 * std::sqrt(0.5), 1e-12);
}

TEST(PoseCovariance, ATurnInThePlaneMovesCornersByTheirDistanceFromTheMiddle) {
  const RigidTransform facing = tag_pose(plain_camera(), {319.5, 239.5}, 0.5, {0, 0, 0});
  PoseCovariance covariance{};
  covariance[6 * 2 + 2] = 1e-6;  // a thousandth about the camera's z
  const double half_diagonal_px = 600 * kSize_m / std::sqrt(2.0) / 0.5;
  EXPECT_NEAR(corner_sigma_px(plain_camera(), facing, covariance, kSize_m), 1e-3 * half_diagonal_px * std::sqrt(0.5), 1e-12);
}

TEST(PoseCovariance, GrowsWithTheSquareOfTheCornersErrors) {
  const RigidTransform pose = tag_pose(plain_camera(), {400, 180}, 0.4, {20, 30, 0});
  const PoseCovariance one = covariance_from_corners(plain_camera(), pose, kSize_m, 0.02),
                       three = covariance_from_corners(plain_camera(), pose, kSize_m, 0.06);
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(three[i], 9 * one[i], 1e-9 * std::abs(three[i]) + 1e-20);
}

}  // namespace
}  // namespace catchlight::tracking
