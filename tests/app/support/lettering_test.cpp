// The face of all lettering, by what any face must have.
#include "app/support/lettering.hpp"

#include <gtest/gtest.h>

#include <set>

namespace catchlight::app {
namespace {

TEST(Lettering, StaysBetweenDescenderAndCapitalAndWithinItsWidth) {
  for (char character = '!'; character <= '~'; ++character) {
    const std::string text(1, character);
    const auto lines = lettering(text);
    ASSERT_FALSE(lines.empty()) << text;
    for (const PenLine& line : lines) {
      EXPECT_GE(line.size(), 2u) << text;
      for (const glm::dvec2& point : line) {
        EXPECT_GE(point.x, 0) << text;
        EXPECT_LE(point.x, lettering_width(text) + 1e-12) << text;
        EXPECT_GE(point.y, -1 - 0.1) << text;
        EXPECT_LE(point.y, kLetteringDescent + 1e-12) << text;
      }
    }
  }
}

TEST(Lettering, NoTwoCharactersLookAlike) {
  std::set<std::vector<std::pair<double, double>>> seen;
  for (char character = '!'; character <= '~'; ++character) {
    std::vector<std::pair<double, double>> points;
    for (const PenLine& line : lettering(std::string(1, character)))
      for (const glm::dvec2& point : line) points.emplace_back(point.x, point.y);
    if (character == 'O') continue;  // as a nought
    EXPECT_TRUE(seen.insert(points).second) << character;
  }
}

TEST(Lettering, CharactersFollowEachOtherApart) {
  const double a = lettering_width("a"), b = lettering_width("b"), gap = lettering_width("ab") - a - b;
  EXPECT_GT(gap, 0);
  EXPECT_NEAR(lettering_width("a b"), lettering_width("ab") + gap + lettering_width(" "), 1e-12);
  EXPECT_EQ(lettering_width(""), 0);
  EXPECT_NEAR(lettering("ab").back().front().x - lettering("b").back().front().x, a + gap, 1e-12);
}

TEST(Lettering, WhatIsNotAsciiIsABox) {
  EXPECT_EQ(lettering("\x01").size(), 1u);
  EXPECT_EQ(lettering("\x01"), lettering("\x7f"));
}

TEST(Lettering, IsWrittenWhereItIsAsked) {
  cv::Mat1b picture(60, 60, std::uint8_t{255});
  write_text(picture, "I", {20, 40}, 20, cv::Scalar(0));
  for (int y = 22; y <= 38; ++y) EXPECT_LT(picture(y, 20), 64) << y;
  EXPECT_EQ(picture(15, 20), 255);
  EXPECT_EQ(picture(46, 20), 255);
}

}  // namespace
}  // namespace catchlight::app
