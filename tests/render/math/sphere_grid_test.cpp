#include "render/math/sphere_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace catchlight::render {
namespace {

TEST(SphereGrid, EveryCellHoldsItsMiddle) {
  const SphereGrid grid(37);
  for (int cell = 0; cell < grid.cells(); ++cell) EXPECT_EQ(grid.cell_of(grid.middle_of(cell)), cell);
}

TEST(SphereGrid, CellsAreNearlyOfOneSize) {
  const SphereGrid grid(60);
  std::vector<int> count(grid.cells());
  constexpr int kPoints = 2'000'000;
  for (int i = 0; i < kPoints; ++i) {  // Fibonacci's lattice: evenly spread over the sphere
    const double y = 1 - 2 * (i + 0.5) / kPoints, turn = i * std::numbers::pi * (3 - std::sqrt(5.0)), r = std::sqrt(1 - y * y);
    ++count[grid.cell_of({r * std::cos(turn), y, r * std::sin(turn)})];
  }
  const double mean = static_cast<double>(kPoints) / grid.cells();
  EXPECT_GT(*std::ranges::min_element(count), 0.6 * mean);
  EXPECT_LT(*std::ranges::max_element(count), 1.3 * mean);
}

TEST(SphereGrid, NeighboursAreMutualAndNear) {
  constexpr int kRings = 25;
  const SphereGrid grid(kRings);
  for (int cell = 0; cell < grid.cells(); ++cell) {
    const std::vector<int> near = grid.neighbours(cell);
    EXPECT_GE(near.size(), 3u);
    for (const int other : near) {
      EXPECT_NE(other, cell);
      EXPECT_TRUE(std::ranges::count(grid.neighbours(other), cell) == 1) << cell << ", " << other;
      EXPECT_GT(glm::dot(grid.middle_of(cell), grid.middle_of(other)), std::cos(2.3 * std::numbers::pi / kRings));
    }
  }
}

TEST(SphereGrid, HasNoSeamAtThePolesOrBehind) {
  const SphereGrid grid(40);
  for (const glm::dvec3& place : {glm::dvec3(0, 1, 0), {0, -1, 0}, {0, 0, -1}}) {
    // Two points a hair apart on both sides of the place lie in the same cell or in neighbours.
    for (const glm::dvec3& aside : {glm::dvec3(1, 0, 0), {0, 0.3, 1}}) {
      const int a = grid.cell_of(glm::normalize(place + 1e-3 * aside)), b = grid.cell_of(glm::normalize(place - 1e-3 * aside));
      EXPECT_TRUE(a == b || std::ranges::count(grid.neighbours(a), b) == 1);
    }
  }
}

}  // namespace
}  // namespace catchlight::render
