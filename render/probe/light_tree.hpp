// The light of a cube map gathered in a quadtree per face, to be summed under lobes of any width.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "catchlight/image.hpp"

namespace catchlight::render {

/// Sums of radiance under a GGX lobe over all directions, as Barnes & Hut (Nature 324, 1986) sum gravity: what is small against
/// the lobe's width where it stands counts as one light, at its centre of mass. Unlike random samples this finds every sun and
/// leaves no dots.
class LightTree {
 public:
  /// `cube`: six stacked faces, size a power of two from 8, 3 channels.
  explicit LightTree(const Image& cube);

  /// Mean radiance around each of `reflected` (length 1), weighted by D(h) n.l for n = v = reflected. Quick where neighbours in
  /// the list are neighbours on the sphere; a mean does not depend on which others are asked for.
  void under_lobes(std::span<const glm::vec3> reflected, float alpha, std::span<glm::vec3> means) const;

 private:
  struct Node {
    glm::vec3 flux{0};  ///< radiance * solid angle
    float solid_angle_sr = 0;
    glm::vec3 middle{0};  ///< mean of the directions in it
    float size_rad = 0;
    glm::vec3 middle_of_light{0};
  };
  struct Level {
    int size = 0;
    std::vector<Node> nodes;
    std::size_t index(int face, int x, int y) const { return (static_cast<std::size_t>(face) * size + y) * size + x; }
  };
  struct Lobes;

  static Level finest_level(const Image& cube);
  static Level coarser_level(const Level& fine);
  static void add_all(std::span<const Level> levels, Lobes& lobes);

  std::vector<Level> levels_;  ///< coarsest (8 x 8 a face) first
};

}  // namespace catchlight::render
