#include "app/tools/probe_view/probe_statistics.hpp"

#include "app/tools/probe_view/mirror_ball.hpp"
#include "catchlight/image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace catchlight::app {
namespace {

constexpr double kPi = glm::pi<double>();

render::Probe constant_probe(const glm::vec3& radiance, render::ProbeLayout layout = render::ProbeLayout::latlong) {
  render::Probe probe{Image(64, layout == render::ProbeLayout::latlong ? 32 : 64), layout};
  for (int y = 0; y < probe.image.height; ++y)
    for (int x = 0; x < probe.image.width; ++x)
      for (int c = 0; c < 3; ++c) probe.image.pixel(x, y)[c] = radiance[c];
  return probe;
}

/// Black but for one texel, at the direction nearest to `direction`.
render::Probe spot_probe(const glm::dvec3& direction, float radiance) {
  render::Probe probe = constant_probe(glm::vec3(0));
  const glm::dvec2 at = render::texel_from_direction(probe.layout, probe.image.width, probe.image.height, direction);
  for (int c = 0; c < 3; ++c)
    probe.image.pixel(static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y)))[c] = radiance;
  return probe;
}

TEST(ProbeStatistics, ConstantProbeIsItsOwnMeanMaxAndLogAverage) {
  const ProbeStatistics statistics = measure_probe(constant_probe(glm::vec3(2)), 4);
  EXPECT_NEAR(statistics.max, 2, 1e-6);
  EXPECT_NEAR(statistics.min_lit, 2, 1e-6);
  EXPECT_NEAR(statistics.mean, 2, 1e-6);
  EXPECT_NEAR(statistics.log_average, 2, 1e-5);  // delta is a millionth
  EXPECT_NEAR(statistics.range_ev, 0, 1e-6);
}

/// Irradiance of constant radiance L is pi L on every surface, per channel.
TEST(ProbeStatistics, ConstantProbeGivesPiTimesItsRadiance) {
  const ProbeStatistics statistics = measure_probe(constant_probe({1, 2, 3}), 1);
  for (int c = 0; c < 3; ++c) {
    // The horizon's texels of a 64 x 32 map are halved at the plane; their share is below 1e-2.
    EXPECT_NEAR(statistics.irradiance_up[c] / kPi, c + 1, 0.01 * (c + 1));
    EXPECT_NEAR(statistics.irradiance_down[c] / kPi, c + 1, 0.01 * (c + 1));
  }
}

/// The sphere's area times the square, all of it in band 0.
TEST(ProbeStatistics, ConstantProbeHasAllItsEnergyInBandZero) {
  const ProbeStatistics statistics = measure_probe(constant_probe(glm::vec3(2)), 4);
  EXPECT_NEAR(statistics.energy, 4 * kPi * 4, 1e-4);
  EXPECT_NEAR(statistics.band_energy.at(0), statistics.energy, 1e-3);
  // Texels are summed at their centres, which errs by (pi / 31)^2 / 24 = 4e-4 of the amplitude: 2e-7 of the energy a band.
  for (std::size_t l = 1; l < 4; ++l) EXPECT_NEAR(statistics.band_energy.at(l), 0, 1e-6 * statistics.energy) << "band " << l;
}

/// Bessel's inequality: no number of bands holds more than there is.
TEST(ProbeStatistics, BandsNeverHoldMoreThanAll) {
  const ProbeStatistics statistics = measure_probe(spot_probe({0.6, 0.64, 0.48}, 1000), 8);
  double held = 0;
  for (const double energy : statistics.band_energy) held += energy;
  EXPECT_GT(held, 0);
  EXPECT_LE(held, statistics.energy);
}

TEST(ProbeStatistics, OneTexelIsFoundFromEveryAxis) {
  for (const glm::dvec3& axis : {glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 0.8, 0.6), glm::dvec3(0, -0.8, 0.6),
                                 glm::dvec3(0, 0, 1), glm::dvec3(0, 0.6, -0.8)}) {
    const ProbeStatistics statistics = measure_probe(spot_probe(axis, 50), 1);
    EXPECT_GT(glm::dot(statistics.brightest, axis), std::cos(2 * kPi / 63))
        << axis.x << ' ' << axis.y << ' ' << axis.z;  // one texel
    EXPECT_NEAR(statistics.max, 50, 1e-4);
  }
}

TEST(ProbeStatistics, LightFromAboveLightsWhatFacesUp) {
  const ProbeStatistics statistics = measure_probe(spot_probe({0.1, 0.9, 0.1}, 100), 1);
  EXPECT_GT(statistics.irradiance_up.g, 0);
  EXPECT_EQ(statistics.irradiance_down.g, 0);
}

TEST(ProbeStatistics, BlackProbeHasFiniteFigures) {
  const ProbeStatistics statistics = measure_probe(constant_probe(glm::vec3(0)), 3);
  for (const double figure :
       {statistics.max, statistics.min_lit, statistics.mean, statistics.log_average, statistics.range_ev, statistics.energy})
    EXPECT_EQ(figure, 0);
}

TEST(ProbeStatistics, OneSunTexelKeepsTheLogAverageFinite) {
  const ProbeStatistics statistics = measure_probe(spot_probe({0, 0.6, 0.8}, 1e6), 3);
  EXPECT_TRUE(std::isfinite(statistics.log_average));
  EXPECT_GT(statistics.log_average, 0);
  EXPECT_LT(statistics.log_average, statistics.mean);
}

/// Texels outside a mirror ball's disc stand for no direction and count for nothing.
TEST(ProbeStatistics, CornersOfAMirrorBallDoNotCount) {
  render::Probe probe = constant_probe(glm::vec3(1), render::ProbeLayout::mirror_ball);
  for (int c = 0; c < 3; ++c) probe.image.pixel(0, 0)[c] = 1e6f;
  EXPECT_NEAR(measure_probe(probe, 1).max, 1, 1e-6);
}

// --- the preview: what a mirror ball shows a camera at tag -y -----------------------------------------------------------

/// The preview's pixel where the ball mirrors what comes from `direction_tag`: by the bisecting normal, not by reflecting.
glm::dvec2 pixel_that_mirrors(const glm::dvec3& direction_tag, int size_px) {
  const glm::dvec3 towards_camera(0, -1, 0);
  const glm::dvec3 normal = glm::normalize(direction_tag + towards_camera);
  return {(normal.x + 1) / 2 * size_px - 0.5, (1 - normal.z) / 2 * size_px - 0.5};
}

glm::dvec2 brightest_pixel(const Image& image) {
  glm::dvec2 weighted(0);
  double sum = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      weighted += static_cast<double>(image.pixel(x, y)[0]) * glm::dvec2(x, y);
      sum += image.pixel(x, y)[0];
    }
  return weighted / sum;
}

class MirrorBallPreview : public ::testing::TestWithParam<glm::dvec3> {};

TEST_P(MirrorBallPreview, ShowsALampWhereItStands) {
  constexpr int kSize = 128;
  const glm::dvec3 direction_tag = glm::normalize(GetParam());
  const glm::dvec3 direction_probe(direction_tag.x, direction_tag.z, -direction_tag.y);  // probe +y = tag +z, probe +z = tag -y
  const Image ball = mirror_ball_preview(spot_probe(direction_probe, 100), 0, kSize);
  const glm::dvec2 expected = pixel_that_mirrors(direction_tag, kSize), seen = brightest_pixel(ball);
  // A texel is 5.7 degrees; the ball turns a normal by half of it: at most 0.05 radii, 3.2 px.
  EXPECT_NEAR(seen.x, expected.x, 3.2);
  EXPECT_NEAR(seen.y, expected.y, 3.2);
}

INSTANTIATE_TEST_SUITE_P(Lamps, MirrorBallPreview,
                         ::testing::Values(glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 0.2, 1),
                                           glm::dvec3(0, 0.2, -1), glm::dvec3(0, -1, 0), glm::dvec3(0.5, -1, 0.7)));

TEST(MirrorBallPreview, LampBehindTheCameraIsInTheMiddle) {
  const glm::dvec2 seen = brightest_pixel(mirror_ball_preview(spot_probe({0, 0, 1}, 100), 0, 64));
  EXPECT_NEAR(seen.x, 31.5, 1.6);
  EXPECT_NEAR(seen.y, 31.5, 1.6);
}

/// Counter-clockwise from above: what was behind the camera (tag -y) goes to its right (tag +x).
TEST(MirrorBallPreview, YawTurnsTheLightCounterClockwiseFromAbove) {
  const glm::dvec2 seen = brightest_pixel(mirror_ball_preview(spot_probe({0, 0, 1}, 100), 90, 64));
  EXPECT_GT(seen.x, 45);
  EXPECT_NEAR(seen.y, 31.5, 1.6);
}

TEST(MirrorBallPreview, IsTransparentAroundADiscOfTheRightArea) {
  constexpr int kSize = 64;
  const Image ball = mirror_ball_preview(constant_probe(glm::vec3(0.5f)), 0, kSize);
  double area = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      area += ball.pixel(x, y)[3];
      EXPECT_NEAR(ball.pixel(x, y)[0], 0.5f * ball.pixel(x, y)[3], 1e-6) << "premultiplied at " << x << ", " << y;
    }
  EXPECT_NEAR(area, kPi / 4 * kSize * kSize, 0.002 * kSize * kSize);
  EXPECT_EQ(ball.pixel(0, 0)[3], 0);
  EXPECT_EQ(ball.pixel(kSize / 2, kSize / 2)[3], 1);
}

}  // namespace
}  // namespace catchlight::app
