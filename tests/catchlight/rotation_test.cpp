// Rotation vectors against OpenCV's Rodrigues, and at the ends of their range.
#include "catchlight/rotation.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <opencv2/calib3d.hpp>

namespace catchlight {
namespace {

constexpr double kPi = std::numbers::pi;

glm::dmat3 opencv_matrix(const glm::dvec3& vector) {
  cv::Matx33d matrix;
  cv::Rodrigues(cv::Vec3d(vector.x, vector.y, vector.z), matrix);
  glm::dmat3 result;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) result[column][row] = matrix(row, column);
  return result;
}

void expect_near(const glm::dmat3& a, const glm::dmat3& b, double tolerance) {
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) EXPECT_NEAR(a[column][row], b[column][row], tolerance) << column << ", " << row;
}

const glm::dvec3 kAxes[] = {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0.6, 0, -0.8}, {2 / 7.0, 3 / 7.0, 6 / 7.0}};

TEST(Rotation, MatricesAreOpenCvs) {
  for (const glm::dvec3& axis : kAxes)
    for (const double angle : {0.0, 1e-9, 1e-4, 0.3, 1.7, 3.1, kPi, 5.0, 12.0})
      expect_near(rotation_matrix(angle * axis), opencv_matrix(angle * axis), 1e-13);
}

TEST(Rotation, AVectorComesBackFromItsMatrix) {
  for (const glm::dvec3& axis : kAxes)
    for (const double angle : {1e-10, 1e-7, 1e-4, 0.01, 0.3, 1.7, 3.0, kPi - 1e-6}) {
      const glm::dvec3 back = rotation_vector(rotation_matrix(angle * axis));
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(back[i], angle * axis[i], 1e-9 * angle + 1e-15) << angle;
    }
}

TEST(Rotation, MoreThanHalfATurnIsLessTheOtherWay) {
  const glm::dvec3 back = rotation_vector(rotation_matrix({0, 0, 1.5 * kPi}));
  EXPECT_NEAR(back.z, -0.5 * kPi, 1e-12);
  EXPECT_NEAR(glm::length(glm::dvec2(back)), 0, 1e-12);
}

TEST(Rotation, HalfATurnHasEitherSign) {
  for (const glm::dvec3& axis : kAxes) {
    const glm::dvec3 back = rotation_vector(opencv_matrix(kPi * axis));
    EXPECT_NEAR(glm::length(back), kPi, 1e-7);
    EXPECT_NEAR(std::abs(glm::dot(back, axis)), kPi, 1e-7);
  }
}

TEST(Rotation, NoTurnIsTheZeroVector) {
  EXPECT_EQ(rotation_vector(glm::dmat3(1.0)), glm::dvec3(0));
  expect_near(rotation_matrix(glm::dvec3(0)), glm::dmat3(1.0), 0);
}

TEST(Rotation, TheAngleBetweenTwoIsThatOfTheTurnFromOneToTheOther) {
  const glm::dmat3 start = rotation_matrix({0.7, -1.1, 0.4});
  for (const double angle : {0.0, 1e-8, 0.3, 3.0})
    EXPECT_NEAR(angle_between_rad(start, rotation_matrix(angle * kAxes[3]) * start), angle, 1e-14) << angle;
}

TEST(Rotation, TurnsAboutOneAxisAddUp) {
  const glm::dvec3 axis = kAxes[4];
  expect_near(rotation_matrix(0.4 * axis) * rotation_matrix(0.9 * axis), rotation_matrix(1.3 * axis), 1e-14);
}

}  // namespace
}  // namespace catchlight
