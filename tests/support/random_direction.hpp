// Random directions.
#pragma once

#include <glm/glm.hpp>
#include <random>

namespace catchlight {

/// A direction of length 1; all are as likely.
template <typename Float>
glm::vec<3, Float> random_direction(std::mt19937& numbers) {
  std::normal_distribution<Float> normal;
  return glm::normalize(glm::vec<3, Float>(normal(numbers), normal(numbers), normal(numbers)));
}

}  // namespace catchlight
