#include "app/photometry/exposure.hpp"

#include <gtest/gtest.h>

#include <random>

namespace catchlight::app {
namespace {

constexpr double kWhite = 0.8, kBlack = 0.04;

tracking::TagPhotometry photographed(const glm::dvec3& gain, const glm::dvec3& flare) {
  return {gain * kWhite + flare, gain * kBlack + flare, 100, 100, glm::bvec3(false)};
}

tracking::TagPhotometry photographed_cells(double white, double black) {
  return {glm::dvec3(white), glm::dvec3(black), 100, 100, glm::bvec3(false)};
}

TEST(ReadExposure, SolvesGainAndFlarePerChannel) {
  const glm::dvec3 gain{0.5, 0.7, 0.9}, flare{0.01, 0.02, 0.0};
  const TagReading reading = read_exposure(photographed(gain, flare), kWhite, kBlack);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(reading.exposure.white[c], gain[c], 1e-12);
    EXPECT_NEAR(reading.exposure.black[c], flare[c], 1e-12);
  }
}

TEST(ReadExposure, CrushedBlacksLeaveTheGainToTheWhiteCells) {
  const TagExposure exposure = read_exposure(photographed_cells(0.4, 0.0), kWhite, kBlack).exposure;
  EXPECT_DOUBLE_EQ(exposure.white.x, 0.5);
  EXPECT_DOUBLE_EQ(exposure.black.x, 0.0);
}

TEST(ReadExposure, AnAllBlackPictureSaysNothing) {
  const TagReading reading = read_exposure(tracking::TagPhotometry{}, kWhite, kBlack);
  for (const ExposureSource source : reading.sources) EXPECT_EQ(source, ExposureSource::nothing);
}

TEST(ReadExposure, AClippedChannelLeavesTheBlackCellsToGuessBy) {
  tracking::TagPhotometry clipped = photographed(glm::dvec3(1.5), glm::dvec3(0));
  clipped.is_clipped = {true, false, true};
  clipped.black_linear.b = 0;
  const TagReading reading = read_exposure(clipped, kWhite, kBlack);
  EXPECT_EQ(reading.sources, (std::array{ExposureSource::black, ExposureSource::tag, ExposureSource::nothing}));
  EXPECT_NEAR(reading.exposure.white.r, 1.5, 1e-12);
  EXPECT_NEAR(reading.exposure.white.g, 1.5, 1e-12);
}

TEST(ExposureGain, PaperUnderTheProbesIrradianceComesOutAsPhotographed) {
  const glm::dvec3 white{0.5, 0.6, 0.7}, paper_radiance{2.0, 1.0, 0.25};
  const glm::dvec3 gain = exposure_gain({"match", 0}, white, paper_radiance);
  for (int c = 0; c < 3; ++c) EXPECT_DOUBLE_EQ(gain[c] * paper_radiance[c], white[c]);
}

TEST(ExposureGain, TheProbesScaleCancels) {
  const glm::dvec3 white{0.5, 0.6, 0.7}, paper_radiance{2.0, 1.0, 0.25};
  const glm::dvec3 once = exposure_gain({"match", 0}, white, paper_radiance);
  const glm::dvec3 scaled = exposure_gain({"match", 0}, white, paper_radiance * 1000.0);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(once[c], scaled[c] * 1000.0, 1e-12);
}

TEST(ExposureGain, StopsDoubleAndFixedIgnoresTheTag) {
  EXPECT_DOUBLE_EQ(exposure_gain({"match", 1}, glm::dvec3(0.5), glm::dvec3(1.0)).x, 1.0);
  EXPECT_DOUBLE_EQ(exposure_gain({"fixed", -2}, glm::dvec3(0.5), glm::dvec3(7.0)).x, 0.25);
}

TEST(ExposureGain, TwentyStopsEitherWayAreFiniteAndExact) {
  for (const char* mode : {"match", "fixed"})
    for (const double ev : {-20.0, 20.0}) {
      const glm::dvec3 gain = exposure_gain({mode, ev}, glm::dvec3(0.5), glm::dvec3(0.5));
      EXPECT_EQ(gain, glm::dvec3(std::exp2(ev))) << mode << " " << ev;
    }
}

TEST(ExposureGain, ProbeBlackInOneChannelStaysFinite) {
  const glm::dvec3 gain = exposure_gain({"match", 0}, glm::dvec3(0.5), {1.0, 0.0, 1.0});
  EXPECT_EQ(gain.y, 0.0);
  EXPECT_TRUE(std::isfinite(gain.x));
}

}  // namespace
}  // namespace catchlight::app
