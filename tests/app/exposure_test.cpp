#include "app/exposure.hpp"

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

TEST(ExposureMatcher, SolvesGainAndFlarePerChannel) {
  ExposureMatcher matcher(kWhite, kBlack);
  const glm::dvec3 gain{0.5, 0.7, 0.9}, flare{0.01, 0.02, 0.0};
  const TagExposure exposure = matcher.update(photographed(gain, flare)).exposure;
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(exposure.white[c], gain[c], 1e-12);
    EXPECT_NEAR(exposure.black[c], flare[c], 1e-12);
  }
}

TEST(ExposureMatcher, CrushedBlacksLeaveTheGainToTheWhiteCells) {
  ExposureMatcher matcher(kWhite, kBlack);
  const TagExposure exposure = matcher.update(photographed_cells(0.4, 0.0)).exposure;
  EXPECT_DOUBLE_EQ(exposure.white.x, 0.5);
  EXPECT_DOUBLE_EQ(exposure.black.x, 0.0);
}

TEST(ExposureMatcher, HoldsTheLastAnswerOverLostFrames) {
  ExposureMatcher matcher(kWhite, kBlack);
  const glm::dvec3 before = matcher.update(photographed(glm::dvec3(0.6), glm::dvec3(0.0))).exposure.white;
  const MatchedExposure held = matcher.update({});
  EXPECT_EQ(held.exposure.white, before);
  EXPECT_TRUE(held.is_held());
}

TEST(ExposureMatcher, TheSameFrameAThousandTimesGivesTheSameValueToTheLastBit) {
  ExposureMatcher matcher(kWhite, kBlack);
  const auto photometry = photographed({0.31, 0.32, 0.33}, glm::dvec3(0.003));
  const TagExposure first = matcher.update(photometry).exposure;
  TagExposure last;
  for (int i = 0; i < 1000; ++i) last = matcher.update(photometry).exposure;
  EXPECT_EQ(first.white, last.white);
  EXPECT_EQ(first.black, last.black);
}

TEST(ExposureMatcher, FollowsTheCameraAtOnce) {
  ExposureMatcher matcher(kWhite, kBlack);
  matcher.update(photographed(glm::dvec3(0.3), glm::dvec3(0.0)));
  EXPECT_NEAR(matcher.update(photographed(glm::dvec3(0.6), glm::dvec3(0.0))).exposure.white.x, 0.6, 1e-12);
}

TEST(ExposureMatcher, AllBlackPictureKeepsTheLastAnswer) {
  ExposureMatcher matcher(kWhite, kBlack);
  matcher.update(photographed(glm::dvec3(0.3), glm::dvec3(0.0)));
  EXPECT_NEAR(matcher.update(tracking::TagPhotometry{}).exposure.white.x, 0.3, 1e-12);
}

TEST(ExposureMatcher, AClippedChannelFollowsTheBrighteningOfTheRest) {
  ExposureMatcher matcher(kWhite, kBlack);
  matcher.update(photographed({0.5, 0.6, 0.7}, glm::dvec3(0.01)));
  tracking::TagPhotometry bright = photographed({1.0, 1.2, 1.4}, glm::dvec3(0.02));
  bright.is_clipped = {false, true, true};
  bright.white_linear = glm::min(bright.white_linear, glm::dvec3(1));
  const MatchedExposure matched = matcher.update(bright, {0, 2, 0});
  EXPECT_NEAR(matched.exposure.white.r, 1.0, 1e-12) << "white cells";
  EXPECT_NEAR(matched.exposure.white.g, 1.2, 1e-12) << "twice as bright as before";
  EXPECT_NEAR(matched.exposure.black.g, 0.02, 1e-12) << "flare is light, too";
  EXPECT_NEAR(matched.exposure.white.b, 0.7, 1e-12) << "not known: held";
  EXPECT_EQ(matched.sources, (std::array{ExposureSource::tag, ExposureSource::surface, ExposureSource::held}));
}

TEST(ExposureMatcher, ClippedFramesAreAllMeasuredAgainstTheLastThatWasNot) {
  ExposureMatcher matcher(kWhite, kBlack);
  matcher.update(photographed(glm::dvec3(0.6), glm::dvec3(0)));
  tracking::TagPhotometry clipped = photographed(glm::dvec3(1.25), glm::dvec3(0));
  clipped.is_clipped = glm::bvec3(true);
  TagExposure last;
  for (int i = 0; i < 1000; ++i) last = matcher.update(clipped, glm::dvec3(1.5)).exposure;
  EXPECT_EQ(last.white, glm::dvec3(0.6 * 1.5)) << "1.5 times, not 1.5 to the thousandth";
}

TEST(ExposureMatcher, WhiteClippedFromTheStartLeavesTheBlackCells) {
  ExposureMatcher matcher(kWhite, kBlack);
  tracking::TagPhotometry clipped = photographed(glm::dvec3(1.5), glm::dvec3(0));
  clipped.is_clipped = glm::bvec3(true);
  const MatchedExposure matched = matcher.update(clipped);
  EXPECT_NEAR(matched.exposure.white.r, 1.5, 1e-12);
  EXPECT_EQ(matched.sources[0], ExposureSource::black);
  clipped.black_linear = glm::dvec3(0);
  EXPECT_TRUE(matcher.update(clipped).is_held()) << "black is not known either";
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
