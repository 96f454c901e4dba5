#include "render/cpu/surface/transferred_light.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace catchlight::render {
namespace {

std::vector<glm::vec3> random_values(std::size_t count) {
  static std::mt19937 random(3);
  std::uniform_real_distribution<float> value(-1, 1);
  std::vector<glm::vec3> values;
  for (std::size_t i = 0; i < count; ++i) values.emplace_back(value(random), value(random), value(random));
  return values;
}

TEST(TransferredLight, IsTheWholeLessWhatIsSplitOff) {
  constexpr std::size_t kPoints = 1300, kCount = 16;
  const std::vector<glm::vec3> transfer = random_values(kPoints * kCount), direct = random_values(kPoints * kCount);
  const SplitLight light{random_values(kCount), random_values(kCount), {}}, unsplit{light.whole, {}, {}};
  const std::vector<glm::vec3> both = transferred_light(transfer, direct, light),
                               whole = transferred_light(transfer, {}, unsplit);
  ASSERT_EQ(both.size(), kPoints);
  ASSERT_EQ(whole.size(), kPoints);
  for (std::size_t p = 0; p < kPoints; ++p) {
    glm::dvec3 sum(0), taken(0);
    for (std::size_t i = 0; i < kCount; ++i) {
      sum += glm::dvec3(light.whole[i]) * glm::dvec3(transfer[p * kCount + i]);
      taken += glm::dvec3(light.split_off[i]) * glm::dvec3(direct[p * kCount + i]);
    }
    EXPECT_LT(glm::distance(glm::dvec3(whole[p]), glm::max(sum, 0.0)), 1e-5);
    EXPECT_LT(glm::distance(glm::dvec3(both[p]), glm::max(sum - taken, 0.0)), 1e-5);
  }
}

TEST(TransferredLight, IsNeverNegativeAndNeverNoNumber) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const SplitLight light{{glm::vec3(1, -2, nan)}, {}, {}};
  EXPECT_EQ(transferred_light(std::vector{glm::vec3(3)}, {}, light), std::vector{glm::vec3(3, 0, 0)});
  EXPECT_TRUE(transferred_light({}, {}, light).empty());
}

}  // namespace
}  // namespace catchlight::render
