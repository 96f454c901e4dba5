#include "render/probe/light_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "catchlight/color.hpp"
#include "render/probe/cube_map.hpp"

namespace catchlight::render {
namespace {

constexpr int kCoarsestSize = 8;

// Largest part of the lobe's width that may count as one light. With centres of mass the error is of second order: under 2 % of
// the peak.
constexpr float kPartOfWidth = 0.25f;

constexpr int kLanes = 8;  // lobes that go through the tree side by side
using Lanes [[gnu::vector_size(kLanes * sizeof(float))]] = float;
using Mask [[gnu::vector_size(kLanes * sizeof(std::int32_t))]] = std::int32_t;  // -1 or 0 a lane

[[gnu::always_inline]] inline bool any(const Mask& mask) {
  using Halves [[gnu::vector_size(kLanes * sizeof(std::int32_t))]] = std::int64_t;
  const auto halves = reinterpret_cast<const Halves&>(mask);
  return (halves[0] | halves[1] | halves[2] | halves[3]) != 0;
}

}  // namespace

// Lobes around axes that are near each other, all of one width.
struct LightTree::Lobes {
  Lanes axis_x{}, axis_y{}, axis_z{};
  float alpha2 = 1;
  Lanes red{}, green{}, blue{}, weight{};
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

// A node counts as one light for the lobes that it is small against, and is taken apart for the others. Each lobe meets its nodes
// in the same order as if it were alone.
[[gnu::target_clones("avx2", "default")]] void LightTree::add_all(std::span<const Level> levels, Lobes& lobes) {
  struct Visit {
    Mask lobes;
    std::size_t level;
    int face, x, y;
  };
  const Lanes axis_x = lobes.axis_x, axis_y = lobes.axis_y, axis_z = lobes.axis_z, zero = axis_x * 0;
  Lanes red = zero, green = zero, blue = zero, weight = zero;
  const float alpha2 = lobes.alpha2;
  const auto project = [&](const glm::vec3& to, Lanes& n_l) __attribute__((always_inline)) {
    n_l = axis_x * to.x + axis_y * to.y + axis_z * to.z;
  };
  // D(h) n.l up to a constant, h half-way between the axis and the light.
  const auto weigh = [&](Lanes & n_l) __attribute__((always_inline)) {
    const Lanes root = (1 + n_l) * 0.5f * (alpha2 - 1) + 1;
    n_l = (n_l > zero ? n_l : zero) / (root * root);
  };
  std::array<Visit, 4 * 16> stack;
  for (int root = 0; root < 6 * kCoarsestSize * kCoarsestSize; ++root) {
    int open = 0;
    stack[open++] = {axis_x == axis_x, 0, root / (kCoarsestSize * kCoarsestSize), root % kCoarsestSize,
                     root / kCoarsestSize % kCoarsestSize};
    while (open > 0) {
      const Visit visit = stack[--open];
      const Node& node = levels[visit.level].nodes[levels[visit.level].index(visit.face, visit.x, visit.y)];
      Lanes n_l;
      project(node.middle, n_l);
      const Mask ahead = visit.lobes & (n_l >= -node.size_rad);  // of the others it is wholly behind
      // Around the angle theta from its axis a lobe changes over about (2 alpha)^2 + theta^2, squared: its tails fall as a power.
      const Mask is_small = node.size_rad * node.size_rad < kPartOfWidth * kPartOfWidth * (4 * alpha2 + 2 * (1 - n_l));
      const bool is_leaf = visit.level + 1 == levels.size();
      const Mask whole = is_leaf ? ahead : ahead & is_small, in_parts = ahead & ~whole;
      if (any(whole)) {
        Lanes light;
        project(node.middle_of_light, light);
        weigh(light), weigh(n_l);
        light = whole ? light : zero;
        red += light * node.flux.x, green += light * node.flux.y, blue += light * node.flux.z;
        weight += whole ? n_l * node.solid_angle_sr : zero;
      }
      if (!any(in_parts)) continue;
      for (int k = 3; k >= 0; --k)
        stack[open++] = {in_parts, visit.level + 1, visit.face, 2 * visit.x + k % 2, 2 * visit.y + k / 2};
    }
  }
  lobes.red = red, lobes.green = green, lobes.blue = blue, lobes.weight = weight;
}

void LightTree::under_lobes(std::span<const glm::vec3> reflected, float alpha, std::span<glm::vec3> means) const {
  for (std::size_t first = 0; first < reflected.size(); first += kLanes) {
    Lobes lobes;
    lobes.alpha2 = alpha * alpha;
    for (std::size_t k = 0; k < kLanes; ++k) {
      const glm::vec3 axis =
          reflected[std::min(first + k, reflected.size() - 1)];  // lanes that are left over: the last one again
      lobes.axis_x[k] = axis.x, lobes.axis_y[k] = axis.y, lobes.axis_z[k] = axis.z;
    }
    add_all(levels_, lobes);
    for (std::size_t k = 0; k < kLanes && first + k < reflected.size(); ++k)
      means[first + k] = glm::vec3(lobes.red[k], lobes.green[k], lobes.blue[k]) / lobes.weight[k];
  }
}

}  // namespace catchlight::render
