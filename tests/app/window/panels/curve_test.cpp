// Curves over more frames than there is room for.
#include "app/window/panels/curve.hpp"

#include <gtest/gtest.h>

namespace catchlight::app {
namespace {

using Values = std::vector<std::optional<double>>;

TEST(Curve, KeepsTheGreatestOfEachPart) {
  EXPECT_EQ(greatest_of_parts({1, 5, 2, 3}, 2), (Values{5, 3}));
  EXPECT_EQ(greatest_of_parts({1, 2, 3, 4, 9}, 2), (Values{3, 9}));
}

TEST(Curve, AGapIsWhereAPartHasNothing) {
  EXPECT_EQ(greatest_of_parts({std::nullopt, std::nullopt, std::nullopt, 3}, 2), (Values{std::nullopt, 3}));
}

TEST(Curve, FewValuesStayAsTheyAre) {
  EXPECT_EQ(greatest_of_parts({1, std::nullopt}, 10), (Values{1, std::nullopt}));
  EXPECT_TRUE(greatest_of_parts({}, 10).empty());
}

TEST(Curve, AShortSpikeIsSeenInALongShot) {
  Values values(10'000, 0.01);
  values[7'777] = 3;
  const Values points = greatest_of_parts(values, 300);
  EXPECT_EQ(std::ranges::count(points, std::optional(3.0)), 1);
}

}  // namespace
}  // namespace catchlight::app
