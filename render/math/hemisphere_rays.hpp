// Low-discrepancy directions over a hemisphere or a cone.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

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

/// Directions around a normal or an axis: those of the points k < count of scrambled_sobol, to single precision, in an order in
/// which neighbours go much the same way. One object serves one thread.
class HemisphereRays {
 public:
  explicit HemisphereRays(int count);

  /// Spans of `count` values, to be filled.
  struct Directions {
    std::span<float> x, y, z;
  };

  /// Density cos / pi around `normal`.
  void fill_hemisphere(const glm::vec3& normal, std::uint32_t seed, const Directions& out);
  /// Which point of the sequence each direction last filled in is. The first 2^n of them are low-discrepancy by themselves.
  std::span<const std::uint32_t> numbers() const { return sorted_k_; }

  /// Uniform within the angle of that cosine around `axis`.
  void fill_cone(const glm::vec3& axis, double cos_cone, std::uint32_t seed, const Directions& out);

 private:
  void scatter(std::uint32_t seed);

  int cell_bits_x_, cell_bits_y_;      ///< rays are sorted into 2^bits by 2^bits cells of the unit square
  std::vector<std::uint32_t> second_;  ///< Sobol's second dimension, bits reversed
  std::vector<std::uint32_t> x_, y_, sorted_x_, sorted_y_, sorted_k_, cell_begin_;
};

}  // namespace catchlight::render
