#include "render/cpu/mirror/lobe_directions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "shaders/shading.h"
#include "tests/support/random_direction.hpp"

namespace catchlight::render {
namespace {

std::mt19937 random_numbers(8);

TEST(LobePoints, AreDealtOutWhole) {
  for (const int count : {1, 3, 4, 32, 37})
    for (const int sharers : {1, 2, 4, 8}) {
      std::vector<int> numbers;
      for (int sharer = 0; sharer < sharers; ++sharer) {
        const LobePoints points = LobePoints::dealt(count, sharers, sharer);
        ASSERT_FALSE(points.number.empty()) << count << " to " << sharers;
        numbers.insert(numbers.end(), points.number.begin(), points.number.end());
      }
      std::ranges::sort(numbers);
      for (int i = 0; i < count; ++i) EXPECT_TRUE(std::ranges::binary_search(numbers, i)) << i << " of " << count;
    }
}

TEST(LobeDirections, AreThoseOfTheFormulas) {
  const LobePoints points = LobePoints::dealt(32, 1, 0);
  LobeDirections directions;
  for (const float alpha : {0.0f, 0.01f, 0.09f, 1.0f})
    for (int i = 0; i < 100; ++i) {
      Lobe lobe{random_direction<float>(random_numbers), random_direction<float>(random_numbers),
                0.1f * random_direction<float>(random_numbers), 0.1f * random_direction<float>(random_numbers), alpha};
      if (glm::dot(lobe.normal, lobe.to_viewer) < 0) lobe.to_viewer = -lobe.to_viewer;
      directions.find(lobe, points, points.number.size());
      const glm::mat3 frame = shading::frame_around(lobe.normal);
      for (std::size_t k = 0; k < points.number.size(); ++k) {
        const glm::vec2 square = shading::hammersley(points.number[k], 32);
        const glm::vec3 facet = frame * shading::visible_normal(lobe.to_viewer * frame, alpha, shading::disc_point(square));
        const glm::vec3 direction = glm::reflect(-lobe.to_viewer, alpha > 0 ? facet : lobe.normal) +
                                    (square.x - 0.5f) * lobe.footprint_x + (square.y - 0.5f) * lobe.footprint_y;
        const float above = glm::dot(direction, lobe.normal);
        if (std::abs(above) < 1e-4f) continue;
        EXPECT_LT(glm::distance(directions.direction(k), glm::normalize(direction)), 1e-4f);
        EXPECT_NEAR(directions.weight(k), above > 0 ? shading::lobe_weight(above, alpha) : 0, 1e-3f);
      }
    }
}

}  // namespace
}  // namespace catchlight::render
