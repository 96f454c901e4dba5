// A reflection map in memory, filtered as OpenGL's seamless cube maps are.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "render/math/float4.hpp"
#include "render/probe/prefilter.hpp"

namespace catchlight::render {

class CubeTexture {
 public:
  /// Texels that are NaN, infinite or negative count as 0, others are kept to a 2000th from 5e-10 to 4e9. A map without levels is
  /// black. Throws Error as check_cubes() does.
  explicit CubeTexture(const ReflectionMap& map);

  int levels() const { return static_cast<int>(levels_.size()); }

  /// Linear within a level, over the edges of faces, and between levels; `level` is clamped to those there are. `direction` need
  /// not have length 1.
  glm::vec3 sample(const glm::vec3& direction, float level) const;

  /// Begins to fetch what sample() will read.
  void prefetch(const glm::vec3& direction, float level) const;

 private:
  /// Floats with 6 bits of exponent, 10 of fraction and no sign; the fourth is unused. What takes time is to fetch them.
  using Texel = std::uint16_t __attribute__((vector_size(8)));
  struct Level {
    int size = 0;               ///< texels along a face
    std::vector<Texel> texels;  ///< faces with a border of one texel, which repeats the neighbours' outermost
  };
  struct Place;
  /// Four texels and a place between them.
  struct Cell {
    const Texel* first;  ///< upper left
    float across, down;
  };

  static Texel coded(const float* rgb);
  static Level make_level(const Image& faces);
  static Cell cell_at(const Level& level, const Place& place);

  std::vector<Level> levels_;
};

}  // namespace catchlight::render
