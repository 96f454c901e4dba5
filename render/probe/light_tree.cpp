#include "render/probe/light_tree.hpp"

#include <algorithm>
#include <cmath>

#include "catchlight/color.hpp"
#include "render/probe/cube_map.hpp"

namespace catchlight::render {
namespace {

constexpr int kCoarsestSize = 8;

// Largest part of the lobe's width that may count as one light. With centres of mass the error is of second order: under 2 % of
// the peak.
constexpr float kPartOfWidth = 0.25f;

}  // namespace

struct LightTree::Lobe {
  glm::vec3 axis;
  float alpha2;
  glm::vec3 light{0};
  float weight = 0;

  // D(h) n.l up to a constant, h half-way between the axis and the light.
  float value(float n_l) const {
    const float root = (1 + n_l) * 0.5f * (alpha2 - 1) + 1;
    return std::max(n_l, 0.0f) / (root * root);
  }

  // Around the angle theta from its axis it changes over about (2 alpha)^2 + theta^2, squared: its tails fall as a power.
  float width_squared(float n_l) const { return 4 * alpha2 + 2 * (1 - n_l); }
};

LightTree::LightTree(const Image& cube) {
  levels_.push_back(finest_level(cube));
  while (levels_.back().size > kCoarsestSize) levels_.push_back(coarser_level(levels_.back()));
  std::reverse(levels_.begin(), levels_.end());
}

LightTree::Level LightTree::finest_level(const Image& cube) {
  Level level{cube.width, std::vector<Node>(static_cast<std::size_t>(cube.width) * cube.height)};
  for (int row = 0; row < cube.height; ++row) {
    const int face = row / level.size, y = row % level.size;
    for (int x = 0; x < level.size; ++x) {
      Node& node = level.nodes[level.index(face, x, y)];
      const float* radiance = cube.pixel(x, row);
      node.solid_angle_sr = static_cast<float>(cube_texel_solid_angle(level.size, x, y));
      node.flux = glm::vec3(radiance[0], radiance[1], radiance[2]) * node.solid_angle_sr;
      node.middle = node.middle_of_light = glm::vec3(cube_texel_direction(face, level.size, x, y));
      node.size_rad = std::sqrt(node.solid_angle_sr);
    }
  }
  return level;
}

LightTree::Level LightTree::coarser_level(const Level& fine) {
  Level level{fine.size / 2, std::vector<Node>(fine.nodes.size() / 4)};
  for (int face = 0; face < 6; ++face) {
    for (int y = 0; y < level.size; ++y) {
      for (int x = 0; x < level.size; ++x) {
        Node& node = level.nodes[level.index(face, x, y)];
        float power = 0;
        for (int k = 0; k < 4; ++k) {
          const Node& part = fine.nodes[fine.index(face, 2 * x + k % 2, 2 * y + k / 2)];
          const float part_power = glm::dot(part.flux, glm::vec3(kLuminanceWeights));
          node.flux += part.flux;
          node.solid_angle_sr += part.solid_angle_sr;
          node.middle += part.solid_angle_sr * part.middle;
          node.middle_of_light += part_power * part.middle_of_light;
          power += part_power;
        }
        node.middle = glm::normalize(node.middle);
        node.middle_of_light = power > 0 ? glm::normalize(node.middle_of_light) : node.middle;
        node.size_rad = std::sqrt(node.solid_angle_sr);
      }
    }
  }
  return level;
}

void LightTree::add(Lobe& lobe, std::size_t level, int face, int x, int y) const {
  const Node& node = levels_[level].nodes[levels_[level].index(face, x, y)];
  const float n_l = glm::dot(lobe.axis, node.middle);
  if (n_l < -node.size_rad) return;  // wholly behind
  const bool is_small = node.size_rad * node.size_rad < kPartOfWidth * kPartOfWidth * lobe.width_squared(n_l);
  if (is_small || level + 1 == levels_.size()) {
    lobe.light += lobe.value(glm::dot(lobe.axis, node.middle_of_light)) * node.flux;
    lobe.weight += lobe.value(n_l) * node.solid_angle_sr;
    return;
  }
  for (int k = 0; k < 4; ++k) add(lobe, level + 1, face, 2 * x + k % 2, 2 * y + k / 2);
}

glm::vec3 LightTree::under_lobe(const glm::vec3& reflected, float alpha) const {
  Lobe lobe{reflected, alpha * alpha};
  const int size = levels_.front().size;
  for (int face = 0; face < 6; ++face) {
    for (int k = 0; k < size * size; ++k) add(lobe, 0, face, k % size, k / size);
  }
  return lobe.light / lobe.weight;
}

}  // namespace catchlight::render
