// What one unit of the probe's radiance is worth in the footage.
#include "app/session/frame_view.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace catchlight::app {
namespace {

TrackRow row_of(const glm::dvec3& white, const glm::dvec3& black = glm::dvec3(0.0)) {
  TrackRow row;
  row.exposure = white;
  row.black = black;
  return row;
}

glm::dvec3 gain_of(ExposureMode mode, double ev, const glm::dvec3& white, const glm::dvec3& paper_radiance) {
  return layer_exposure({mode, ev}, row_of(white), paper_radiance).gain;
}

/// Under `auto` the footage's exposure holds as under `match`: what exposes the picture anew comes after.
TEST(LayerExposure, TheFootagesBlackIsAddedWhereverItsExposureIsFollowed) {
  const TrackRow row = row_of({0.5, 0.6, 0.7}, {0.01, 0.02, 0.03});
  const auto exposure = [&](ExposureMode mode) { return layer_exposure({mode, 0}, row, glm::dvec3(2.0)); };
  EXPECT_EQ(exposure(ExposureMode::match).black, row.black);
  EXPECT_EQ(exposure(ExposureMode::automatic).black, row.black);
  EXPECT_EQ(exposure(ExposureMode::automatic).gain, exposure(ExposureMode::match).gain);
  EXPECT_EQ(exposure(ExposureMode::fixed).black, glm::dvec3(0.0));
}

TEST(ExposureGain, PaperUnderTheProbesIrradianceComesOutAsPhotographed) {
  const glm::dvec3 white{0.5, 0.6, 0.7}, paper_radiance{2.0, 1.0, 0.25};
  const glm::dvec3 gain = gain_of(ExposureMode::match, 0, white, paper_radiance);
  for (int c = 0; c < 3; ++c) EXPECT_DOUBLE_EQ(gain[c] * paper_radiance[c], white[c]);
}

TEST(ExposureGain, TheProbesScaleCancels) {
  const glm::dvec3 white{0.5, 0.6, 0.7}, paper_radiance{2.0, 1.0, 0.25};
  const glm::dvec3 once = gain_of(ExposureMode::match, 0, white, paper_radiance);
  const glm::dvec3 scaled = gain_of(ExposureMode::match, 0, white, paper_radiance * 1000.0);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(once[c], scaled[c] * 1000.0, 1e-12);
}

TEST(ExposureGain, StopsDoubleAndFixedIgnoresTheTag) {
  EXPECT_DOUBLE_EQ(gain_of(ExposureMode::match, 1, glm::dvec3(0.5), glm::dvec3(1.0)).x, 1.0);
  EXPECT_DOUBLE_EQ(gain_of(ExposureMode::fixed, -2, glm::dvec3(0.5), glm::dvec3(7.0)).x, 0.25);
}

TEST(ExposureGain, TheWhiteBalanceIsAGainInEveryMode) {
  const glm::dvec3 balance{0.5, 1, 2}, white{0.5, 0.6, 0.7};
  for (const ExposureMode mode : {ExposureMode::match, ExposureMode::fixed, ExposureMode::automatic}) {
    const glm::dvec3 as_is = gain_of(mode, 1, white, glm::dvec3(0.25));
    EXPECT_EQ(layer_exposure({mode, 1, balance}, row_of(white), glm::dvec3(0.25)).gain, balance * as_is) << name_of(mode);
  }
}

TEST(ExposureGain, TwentyStopsEitherWayAreFiniteAndExact) {
  for (const ExposureMode mode : {ExposureMode::match, ExposureMode::fixed, ExposureMode::automatic})
    for (const double ev : {-20.0, 20.0}) {
      const glm::dvec3 gain = gain_of(mode, ev, glm::dvec3(0.5), glm::dvec3(0.5));
      EXPECT_EQ(gain, glm::dvec3(std::exp2(ev))) << name_of(mode) << " " << ev;
    }
}

TEST(ExposureGain, ProbeBlackInOneChannelStaysFinite) {
  const glm::dvec3 gain = gain_of(ExposureMode::match, 0, glm::dvec3(0.5), {1.0, 0.0, 1.0});
  EXPECT_EQ(gain.y, 0.0);
  EXPECT_TRUE(std::isfinite(gain.x));
}

}  // namespace
}  // namespace catchlight::app
