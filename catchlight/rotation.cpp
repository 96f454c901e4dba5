#include "catchlight/rotation.hpp"

#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace catchlight {

glm::dvec3 rotation_vector(const glm::dmat3& rotation) {
  glm::dquat q = glm::quat_cast(rotation);
  if (q.w < 0) q = -q;
  const glm::dvec3 axis(q.x, q.y, q.z);
  const double sine = glm::length(axis);
  if (sine < 1e-12) return 2.0 * axis;
  return axis * (2 * std::atan2(sine, q.w) / sine);
}

glm::dmat3 rotation_matrix(const glm::dvec3& rotation_vector_rad) {
  const double angle = glm::length(rotation_vector_rad);
  if (angle < 1e-12) return glm::dmat3(1.0);
  return glm::mat3_cast(glm::angleAxis(angle, rotation_vector_rad / angle));
}

double angle_between_rad(const glm::dmat3& a, const glm::dmat3& b) {
  return glm::length(rotation_vector(b * glm::transpose(a)));
}

}  // namespace catchlight
