// Which value of a few is taken.
#include "catchlight/util/statistics.hpp"

#include <gtest/gtest.h>

namespace catchlight {
namespace {

TEST(Median, IsTheMiddleOneOrTheUpperOfTwo) {
  EXPECT_EQ(median<double>({7}), 7);
  EXPECT_EQ(median<double>({3, 1, 2}), 2);
  EXPECT_EQ(median<double>({4, 1, 3, 2}), 3);
  EXPECT_EQ(median<double>({1, 5, 5, 5}), 5);
}

TEST(Quantile, RunsFromTheSmallestToTheLargest) {
  const std::vector<double> values{50, 10, 40, 20, 30};
  EXPECT_EQ(quantile(values, 0), 10);
  EXPECT_EQ(quantile(values, 0.25), 20);
  EXPECT_EQ(quantile(values, 0.5), 30);
  EXPECT_EQ(quantile(values, 1), 50);
}

TEST(Quantile, IsNeverBetweenTwoValues) {
  EXPECT_EQ(quantile<float>({2, 1}, 0.5), 1);
  EXPECT_EQ(quantile<float>({2, 1}, 0.99), 1);
  EXPECT_EQ(quantile<float>({3}, 0.7), 3);
}

TEST(Quantile, LeavesTheGivenValuesAsTheyAre) {
  const std::vector<int> values{3, 1, 2};
  EXPECT_EQ(quantile(values, 1), 3);
  EXPECT_EQ(values, (std::vector<int>{3, 1, 2}));
}

}  // namespace
}  // namespace catchlight
