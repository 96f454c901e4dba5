// Rotations and translations named by the frames they join (docs/conventions.md).
#pragma once

#include <glm/glm.hpp>

namespace catchlight {

/// Rigid motion named by its frames: `a_from_b` maps b's coordinates (metres) to a's.
struct RigidTransform {
  glm::dmat3 rotation{1.0};
  glm::dvec3 translation_m{0.0};
};

inline glm::dvec3 operator*(const RigidTransform& a_from_b, const glm::dvec3& point_b_m) {
  return a_from_b.rotation * point_b_m + a_from_b.translation_m;
}

/// a_from_c = a_from_b * b_from_c.
inline RigidTransform operator*(const RigidTransform& a_from_b, const RigidTransform& b_from_c) {
  return {a_from_b.rotation * b_from_c.rotation, a_from_b * b_from_c.translation_m};
}

inline RigidTransform inverse(const RigidTransform& a_from_b) {
  const glm::dmat3 rotation = glm::transpose(a_from_b.rotation);
  return {rotation, -(rotation * a_from_b.translation_m)};
}

}  // namespace catchlight
