// The random numbers of one path.
#pragma once

#include "render/math/hemisphere_rays.hpp"

namespace catchlight::render::reference {

/// Path `index` of those with one `seed`: pair after pair of coordinates, each pair a shuffled and scrambled Sobol sequence of
/// its own over the paths (Burley, "Practical Hash-based Owen Scrambling", JCGT 2020).
class PointStream {
 public:
  PointStream(std::uint32_t seed, std::uint32_t index) : seed_(mix_bits(seed)), index_(index) {}

  glm::dvec2 next() {
    const std::uint32_t pair = mix_bits(seed_ + 0x9e3779b9u * ++pairs_);
    return scrambled_sobol(owen_scrambled(index_, pair), mix_bits(pair));
  }

 private:
  std::uint32_t seed_, index_, pairs_ = 0;
};

}  // namespace catchlight::render::reference
