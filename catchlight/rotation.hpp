// Rotations as vectors: direction is the axis, length the angle (Rodrigues).
#pragma once

#include <glm/glm.hpp>

namespace catchlight {

/// The vector is at most pi long.
glm::dvec3 rotation_vector(const glm::dmat3& rotation);

glm::dmat3 rotation_matrix(const glm::dvec3& rotation_vector_rad);

/// The angle that takes one orientation to another.
double angle_between_rad(const glm::dmat3& a, const glm::dmat3& b);

}  // namespace catchlight
