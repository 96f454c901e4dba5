// A picture's codes, column by column.
#include "app/window/panels/waveform.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace catchlight::app {
namespace {

constexpr std::size_t kRed = 0, kGreen = 1, kBlue = 2, kLuma = 3;

/// Black on the left, this colour on the right.
RgbPicture halves(int width, int height, const std::array<unsigned char, 3>& right) {
  RgbPicture picture{width, height, {}};
  for (int i = 0; i < width * height; ++i)
    for (const unsigned char code : right) picture.rgb.push_back(i % width < width / 2 ? 0 : code);
  return picture;
}

TEST(Waveform, CountsCodesWhereTheyAre) {
  const Waveform waveform = waveform_of(halves(8, 5, {200, 100, 0}), 4);
  EXPECT_EQ(waveform.at(kRed, 0, 0), 10);
  EXPECT_EQ(waveform.at(kRed, 0, 2), 0);
  EXPECT_EQ(waveform.at(kRed, 200, 2), 10);
  EXPECT_EQ(waveform.at(kGreen, 100, 3), 10);
  EXPECT_EQ(waveform.at(kBlue, 0, 3), 10);
  EXPECT_EQ(waveform.at(kLuma, 114, 3), 10) << "0.2126 * 200 + 0.7152 * 100";
}

TEST(Waveform, EveryPixelOfASmallPictureCountsOnceAChannel) {
  const Waveform waveform = waveform_of(halves(30, 7, {255, 255, 255}), 11);
  for (const auto& counts : waveform.counts) EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0), 30 * 7);
  EXPECT_GT(waveform.at(kLuma, 255, 10), 0);
}

TEST(Waveform, OfALargePictureSomeRowsAreEnough) {
  const Waveform waveform = waveform_of(halves(1920, 1080, {50, 60, 70}), 10);
  const int counted = std::accumulate(waveform.counts[kRed].begin(), waveform.counts[kRed].end(), 0);
  EXPECT_LT(counted, 400'000);
  EXPECT_EQ(waveform.at(kRed, 50, 9), waveform.at(kRed, 0, 0));
}

TEST(Waveform, IsDrawnWithWhiteOnTop) {
  const RgbPicture luma = luma_waveform(waveform_of(halves(4, 4, {255, 255, 255}), 2));
  ASSERT_EQ(luma.width, 2);
  ASSERT_EQ(luma.height, 256);
  EXPECT_EQ(luma.rgb[3], 220) << "the right half is white: the top row's second column is lit";
  EXPECT_EQ(luma.rgb[0], 20) << "the left half is not";
  EXPECT_EQ(luma.rgb[std::size_t{3} * 2 * 255], 220) << "it is black: the lowest row's first column is lit";
}

TEST(Waveform, TheParadeHasAChannelBesideTheOther) {
  const RgbPicture parade = rgb_parade(waveform_of(halves(2, 2, {0, 255, 0}), 2));
  ASSERT_EQ(parade.width, 6);
  EXPECT_EQ(parade.rgb[std::size_t{3} * 1], 20) << "red is nowhere 255";
  EXPECT_GT(parade.rgb[std::size_t{3} * 3 + 1], 200) << "green is, in its right half";
}

}  // namespace
}  // namespace catchlight::app
