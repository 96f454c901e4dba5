#include "render/math/hemisphere_rays.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace catchlight::render {
namespace {

TEST(HemisphereRays, AreNestedAndWellSpread) {
  // Each of the first 2^k points of Sobol's sequence falls into another cell of every dyadic grid of 2^k cells, scrambled or not.
  for (const std::uint32_t seed : {1u, 99u}) {
    for (const int columns : {1, 2, 4, 8, 16, 32, 64, 128, 256}) {
      std::vector<int> hits(256);
      for (std::uint32_t k = 0; k < 256; ++k) {
        const glm::dvec2 at = scrambled_sobol(k, seed);
        ++hits[static_cast<int>(at.x * columns) * (256 / columns) + static_cast<int>(at.y * (256 / columns))];
      }
      EXPECT_EQ(std::count(hits.begin(), hits.end(), 1), 256) << columns << " columns";
    }
  }
}

TEST(HemisphereRays, FollowTheCosine) {
  for (const glm::vec3& normal : {glm::vec3(0, 0, 1), glm::vec3(0, 0, -1), glm::normalize(glm::vec3(1, -2, 0.5f))}) {
    const Hemisphere hemisphere(normal);
    double mean_cos = 0;
    glm::dvec3 mean(0);
    for (std::uint32_t k = 0; k < 4096; ++k) {
      const glm::vec3 direction = hemisphere.direction(scrambled_sobol(k, 3));
      EXPECT_NEAR(glm::length(direction), 1, 1e-6);
      mean_cos += glm::dot(direction, normal) / 4096;
      mean += glm::dvec3(direction) / 4096.0;
    }
    EXPECT_NEAR(mean_cos, 2.0 / 3, 1e-3);
    EXPECT_LT(glm::distance(mean, glm::dvec3(normal) * (2.0 / 3)), 2e-3);
  }
}

}  // namespace
}  // namespace catchlight::render
