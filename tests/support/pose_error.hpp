// How far two poses are apart.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "catchlight/rigid_transform.hpp"

namespace catchlight::tracking {

inline double turn_between_deg(const RigidTransform& a, const RigidTransform& b) {
  // From the Frobenius norm of the difference, 2√2·sin(angle/2): exact for small angles, where the trace's acos is not.
  double squares = 0;
  for (int column = 0; column < 3; ++column) {
    const glm::dvec3 difference = a.rotation[column] - b.rotation[column];
    squares += glm::dot(difference, difference);
  }
  return 2 * std::asin(std::min(1.0, std::sqrt(squares / 8))) * 180 / std::numbers::pi;
}

}  // namespace catchlight::tracking
