// Directions over the lobe around a mirror direction, many at a time.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace catchlight::render {

struct Lobe {
  glm::vec3 to_viewer, normal;
  glm::vec3 footprint_x, footprint_y;  ///< how the mirror direction changes from pixel to pixel
  float alpha = 0;                     ///< 0: a perfect mirror
};

/// Choices among a lobe's directions before the surface gives them their place; a value each.
struct LobePoints {
  std::vector<int> number;            ///< in the whole lobe
  std::vector<float> across, down;    ///< Hammersley's points in the unit square, less its middle
  std::vector<float> disc_x, disc_y;  ///< the same points spread over the unit disc

  /// Those of a lobe of `count` that fall to one of so many sharers. They are dealt out so that each has some all over the lobe.
  static LobePoints dealt(int count, int sharers, int sharer);
};

/// Arrays of a value each.
class LobeDirections {
 public:
  /// Those of the first `count` points.
  void find(const Lobe& lobe, const LobePoints& points, std::size_t count);

  glm::vec3 direction(std::size_t i) const { return {x_[i], y_[i], z_[i]}; }  ///< of length 1
  float weight(std::size_t i) const { return weight_[i]; }                    ///< 0: below the surface

 private:
  std::vector<float> x_, y_, z_, weight_;
};

}  // namespace catchlight::render
