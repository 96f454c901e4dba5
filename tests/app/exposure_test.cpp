#include "app/exposure.hpp"

#include <gtest/gtest.h>

#include <random>

namespace catchlight::app {
namespace {

constexpr double kWhite = 0.8, kBlack = 0.04;

tracking::TagPhotometry photographed(const glm::dvec3& gain, const glm::dvec3& flare) {
  return {gain * kWhite + flare, gain * kBlack + flare, 100, 100};
}

TEST(ExposureMatcher, SolvesGainAndFlarePerChannel) {
  ExposureMatcher matcher(kWhite, kBlack);
  const glm::dvec3 gain{0.5, 0.7, 0.9}, flare{0.01, 0.02, 0.0};
  const TagExposure exposure = matcher.update(photographed(gain, flare));
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(exposure.white[c], gain[c], 1e-12);
    EXPECT_NEAR(exposure.black[c], flare[c], 1e-12);
  }
}

TEST(ExposureMatcher, CrushedBlacksLeaveTheGainToTheWhiteCells) {
  ExposureMatcher matcher(kWhite, kBlack);
  const TagExposure exposure = matcher.update(tracking::TagPhotometry{glm::dvec3(0.4), glm::dvec3(0.0), 100, 100});
  EXPECT_DOUBLE_EQ(exposure.white.x, 0.5);
  EXPECT_DOUBLE_EQ(exposure.black.x, 0.0);
}

TEST(ExposureMatcher, HoldsTheLastAnswerOverLostFrames) {
  ExposureMatcher matcher(kWhite, kBlack);
  const glm::dvec3 before = matcher.update(photographed(glm::dvec3(0.6), glm::dvec3(0.0))).white;
  EXPECT_EQ(matcher.update({}).white, before);
}

TEST(ExposureMatcher, TheSameFrameAThousandTimesGivesTheSameValueToTheLastBit) {
  ExposureMatcher matcher(kWhite, kBlack);
  const auto photometry = photographed({0.31, 0.32, 0.33}, glm::dvec3(0.003));
  const TagExposure first = matcher.update(photometry);
  TagExposure last;
  for (int i = 0; i < 1000; ++i) last = matcher.update(photometry);
  EXPECT_EQ(first.white, last.white);
  EXPECT_EQ(first.black, last.black);
}

TEST(ExposureMatcher, FollowsTheCameraAtOnce) {
  ExposureMatcher matcher(kWhite, kBlack);
  matcher.update(photographed(glm::dvec3(0.3), glm::dvec3(0.0)));
  EXPECT_NEAR(matcher.update(photographed(glm::dvec3(0.6), glm::dvec3(0.0))).white.x, 0.6, 1e-12);
}

TEST(ExposureMatcher, AllBlackPictureKeepsTheLastAnswer) {
  ExposureMatcher matcher(kWhite, kBlack);
  matcher.update(photographed(glm::dvec3(0.3), glm::dvec3(0.0)));
  EXPECT_NEAR(matcher.update(tracking::TagPhotometry{}).white.x, 0.3, 1e-12);
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

TEST(ExposureGain, ProbeBlackInOneChannelStaysFinite) {
  const glm::dvec3 gain = exposure_gain({"match", 0}, glm::dvec3(0.5), {1.0, 0.0, 1.0});
  EXPECT_EQ(gain.y, 0.0);
  EXPECT_TRUE(std::isfinite(gain.x));
}

}  // namespace
}  // namespace catchlight::app
