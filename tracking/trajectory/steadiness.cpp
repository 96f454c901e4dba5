#include "tracking/trajectory/steadiness.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/rotation.hpp"

namespace catchlight::tracking {
namespace {

/// 3x3 block of a pose's covariance on the diagonal: 0 rotation, 3 translation.
glm::dmat3 block(const PoseCovariance& covariance, int at) {
  glm::dmat3 result;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      result[column][row] = covariance[static_cast<std::size_t>(6 * (at + row) + at + column)];
  return result;
}

/// Length of the second interval in units of the first.
double ratio(const TimedPose& first, const TimedPose& second, const TimedPose& third) {
  return (third.time_s - second.time_s) / std::max(second.time_s - first.time_s, 1e-6);
}

glm::dmat3 spread(const TimedPose& first, const TimedPose& second, const TimedPose& third, int at) {
  const double r = ratio(first, second, third);
  return block(third.pose->covariance, at) + (1 + r) * (1 + r) * block(second.pose->covariance, at) +
         r * r * block(first.pose->covariance, at);
}

}  // namespace

Unsteadiness unsteady_turn(const TimedPose& first, const TimedPose& second, const TimedPose& third) {
  const auto turn = [](const TimedPose& from, const TimedPose& to) {
    return rotation_vector(to.pose->camera_from_tag.rotation * glm::transpose(from.pose->camera_from_tag.rotation));
  };
  const glm::dvec3 expected = turn(first, second) * ratio(first, second, third);
  const glm::dvec3 deviation = rotation_vector(rotation_matrix(turn(second, third)) * glm::transpose(rotation_matrix(expected)));
  return {deviation, spread(first, second, third, 0)};
}

Unsteadiness unsteady_shift(const TimedPose& first, const TimedPose& second, const TimedPose& third) {
  const glm::dvec3 a = first.pose->camera_from_tag.translation_m, b = second.pose->camera_from_tag.translation_m;
  const glm::dvec3 expected = b + (b - a) * ratio(first, second, third);
  return {third.pose->camera_from_tag.translation_m - expected, spread(first, second, third, 3)};
}

Unsteadiness plain_turn(const PoseCandidate& first, const PoseCandidate& second) {
  return {rotation_vector(second.camera_from_tag.rotation * glm::transpose(first.camera_from_tag.rotation)),
          block(first.covariance, 0) + block(second.covariance, 0)};
}

double log_density(const Unsteadiness& unsteadiness, double variance) {
  const glm::dmat3 total = unsteadiness.covariance + glm::dmat3(std::max(variance, 1e-14));
  const double square = glm::dot(unsteadiness.deviation, glm::inverse(total) * unsteadiness.deviation);
  return -0.5 * square - 0.5 * std::log(std::max(glm::determinant(total), 1e-60));
}

}  // namespace catchlight::tracking
