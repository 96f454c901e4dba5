// What one unit of the probe's radiance is worth in the footage.
#include "app/session/frame_view.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace catchlight::app {
namespace {

TEST(ExposureGain, PaperUnderTheProbesIrradianceComesOutAsPhotographed) {
  const glm::dvec3 white{0.5, 0.6, 0.7}, paper_radiance{2.0, 1.0, 0.25};
  const glm::dvec3 gain = exposure_gain({ExposureMode::match, 0}, white, paper_radiance);
  for (int c = 0; c < 3; ++c) EXPECT_DOUBLE_EQ(gain[c] * paper_radiance[c], white[c]);
}

TEST(ExposureGain, TheProbesScaleCancels) {
  const glm::dvec3 white{0.5, 0.6, 0.7}, paper_radiance{2.0, 1.0, 0.25};
  const glm::dvec3 once = exposure_gain({ExposureMode::match, 0}, white, paper_radiance);
  const glm::dvec3 scaled = exposure_gain({ExposureMode::match, 0}, white, paper_radiance * 1000.0);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(once[c], scaled[c] * 1000.0, 1e-12);
}

TEST(ExposureGain, StopsDoubleAndFixedIgnoresTheTag) {
  EXPECT_DOUBLE_EQ(exposure_gain({ExposureMode::match, 1}, glm::dvec3(0.5), glm::dvec3(1.0)).x, 1.0);
  EXPECT_DOUBLE_EQ(exposure_gain({ExposureMode::fixed, -2}, glm::dvec3(0.5), glm::dvec3(7.0)).x, 0.25);
}

TEST(ExposureGain, TwentyStopsEitherWayAreFiniteAndExact) {
  for (const ExposureMode mode : {ExposureMode::match, ExposureMode::fixed})
    for (const double ev : {-20.0, 20.0}) {
      const glm::dvec3 gain = exposure_gain({mode, ev}, glm::dvec3(0.5), glm::dvec3(0.5));
      EXPECT_EQ(gain, glm::dvec3(std::exp2(ev))) << name_of(mode) << " " << ev;
    }
}

TEST(ExposureGain, ProbeBlackInOneChannelStaysFinite) {
  const glm::dvec3 gain = exposure_gain({ExposureMode::match, 0}, glm::dvec3(0.5), {1.0, 0.0, 1.0});
  EXPECT_EQ(gain.y, 0.0);
  EXPECT_TRUE(std::isfinite(gain.x));
}

}  // namespace
}  // namespace catchlight::app
