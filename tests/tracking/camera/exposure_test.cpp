#include "tracking/camera/exposure.hpp"

#include <gtest/gtest.h>

namespace catchlight::tracking {
namespace {

constexpr TagAlbedo kAlbedo{0.8, 0.04};

TagPhotometry photographed(const glm::dvec3& gain, const glm::dvec3& flare) {
  return {gain * kAlbedo.white + flare, gain * kAlbedo.black + flare, 100, 100, glm::bvec3(false)};
}

TagPhotometry photographed_cells(double white, double black) {
  return {glm::dvec3(white), glm::dvec3(black), 100, 100, glm::bvec3(false)};
}

TEST(ReadExposure, SolvesGainAndFlarePerChannel) {
  const glm::dvec3 gain{0.5, 0.7, 0.9}, flare{0.01, 0.02, 0.0};
  const TagReading reading = read_exposure(photographed(gain, flare), kAlbedo);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(reading.exposure.white[c], gain[c], 1e-12);
    EXPECT_NEAR(reading.exposure.black[c], flare[c], 1e-12);
  }
}

TEST(ReadExposure, CrushedBlacksLeaveTheGainToTheWhiteCells) {
  const TagExposure exposure = read_exposure(photographed_cells(0.4, 0.0), kAlbedo).exposure;
  EXPECT_DOUBLE_EQ(exposure.white.x, 0.5);
  EXPECT_DOUBLE_EQ(exposure.black.x, 0.0);
}

TEST(ReadExposure, AnAllBlackPictureSaysNothing) {
  const TagReading reading = read_exposure(TagPhotometry{}, kAlbedo);
  for (const ExposureSource source : reading.sources) EXPECT_EQ(source, ExposureSource::nothing);
}

TEST(ReadExposure, AClippedChannelLeavesTheBlackCellsToGuessBy) {
  TagPhotometry clipped = photographed(glm::dvec3(1.5), glm::dvec3(0));
  clipped.is_clipped = {true, false, true};
  clipped.black_linear.b = 0;
  const TagReading reading = read_exposure(clipped, kAlbedo);
  EXPECT_EQ(reading.sources, (std::array{ExposureSource::black, ExposureSource::tag, ExposureSource::nothing}));
  EXPECT_NEAR(reading.exposure.white.r, 1.5, 1e-12);
  EXPECT_NEAR(reading.exposure.white.g, 1.5, 1e-12);
}

}  // namespace
}  // namespace catchlight::tracking
