#include "catchlight/util/thinned_sample.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace catchlight {
namespace {

using Sample = ThinnedSample<std::size_t>;

Sample counted_to(std::size_t end) {
  Sample sample;
  for (std::size_t i = 0; i < end; ++i) sample.add(i);
  return sample;
}

TEST(ThinnedSample, KeepsAShortSeriesWhole) {
  std::vector<std::size_t> all(Sample::kMaxValues);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(counted_to(Sample::kMaxValues).values(), all);
}

/// However long the series is, what is kept is bounded, from its first to nearly its last value, and evenly spaced.
TEST(ThinnedSample, KeepsEvenStepsOfALongOne) {
  for (const std::size_t length : {Sample::kMaxValues + 1, 3 * Sample::kMaxValues, 40 * Sample::kMaxValues + 7}) {
    const std::vector<std::size_t> values = counted_to(length).values();
    ASSERT_LE(values.size(), Sample::kMaxValues);
    ASSERT_GE(values.size(), Sample::kMaxValues / 2);
    const std::size_t step = values[1] - values[0];
    for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(values[i], i * step);
    EXPECT_LT(length - values.back(), 2 * step);
  }
}

}  // namespace
}  // namespace catchlight
