// Low-discrepancy directions over a hemisphere or a cone.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace catchlight::render {

/// x with all its bits mixed (a permutation of 32-bit numbers: Wellons' "lowbias32").
std::uint32_t mix_bits(std::uint32_t x);

/// Owen's nested scrambling of x read as a binary fraction, highest bit first: aligned blocks of 2^k numbers stay blocks,
/// shuffled (Laine & Karras 2011 with the constants of Burley, "Practical Hash-based Owen Scrambling", JCGT 2020).
std::uint32_t owen_scrambled(std::uint32_t x, std::uint32_t seed);

/// A seed that follows from the bits alone: the rays of vertices doubled along a seam are alike.
std::uint32_t seed_of(const glm::vec3& position, const glm::vec3& normal, std::uint32_t seed);

/// Point k of Sobol's sequence in the unit square, Owen-scrambled by `seed` (Burley, "Practical Hash-based Owen Scrambling", JCGT
/// 2020).
glm::dvec2 scrambled_sobol(std::uint32_t k, std::uint32_t seed);

/// Directions around `normal`.
class Hemisphere {
 public:
  explicit Hemisphere(const glm::vec3& normal);
  glm::vec3 direction(const glm::dvec2& square) const;                        ///< density cos / pi
  glm::vec3 cone_direction(const glm::dvec2& square, double cos_cone) const;  ///< uniform within the angle of that cosine

 private:
  glm::dvec3 tangent_, bitangent_, normal_;
};

}  // namespace catchlight::render
