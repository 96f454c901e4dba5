#include "render/made_probe/sky.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace catchlight::render {
namespace {

struct Point {
  double turbidity, sun_elevation_deg, from_zenith_deg, from_sun_deg;
  LuminanceXy expected;
};
class ClearSkyPoint : public ::testing::TestWithParam<Point> {};

TEST_P(ClearSkyPoint, IsAsTheFormulasOfThePaperGiveIt) {
  const Point& point = GetParam();
  const LuminanceXy light = ClearSky(point.turbidity, glm::radians(point.sun_elevation_deg))
                                .at(glm::radians(point.from_zenith_deg), glm::radians(point.from_sun_deg));
  EXPECT_NEAR(light.luminance, point.expected.luminance, 1e-4);
  EXPECT_NEAR(light.x, point.expected.x, 1e-5);
  EXPECT_NEAR(light.y, point.expected.y, 1e-5);
}

// Worked out apart from the program, from the paper's appendix A.2 written out term by term.
INSTANTIATE_TEST_SUITE_P(
    Paper, ClearSkyPoint,
    ::testing::Values(Point{2, 60, 0, 30, {5.8867, 0.25142, 0.25592}}, Point{2, 60, 45, 75, {4.2272, 0.23508, 0.24304}},
                      Point{3, 35, 60, 73.33423, {6.6250, 0.25225, 0.26441}}, Point{3, 35, 50, 5, {24.4067, 0.28602, 0.29691}},
                      Point{6, 20, 80, 10, {21.7926, 0.39770, 0.39181}}, Point{6, 10, 30, 95.49841, {3.4416, 0.28281, 0.30605}}));

/// The illuminance of a surface that faces the sun, in klx.
double sunlight_klx(double turbidity, double elevation_deg) {
  const double disc_sr = glm::two_pi<double>() * (1 - std::cos(glm::radians(kSunDiameter_deg / 2)));
  return sun_disc(turbidity, glm::radians(elevation_deg)).luminance * disc_sr;
}

// Above the air the sun brings 128 to 134 klx; through clear air of a summer's noon about 100.
TEST(SunDisc, BringsWhatIsMeasuredOnTheGround) {
  EXPECT_NEAR(sunlight_klx(2, 60), 103, 8);
  EXPECT_NEAR(sunlight_klx(3, 30), 72, 10);
  EXPECT_LT(sunlight_klx(3, 5), 20);
  EXPECT_GT(sunlight_klx(3, 5), 3);
}

// The air takes a share per air mass: in its logarithm that is a line over 1 / sin(elevation), where the sun is high.
TEST(SunDisc, FollowsBouguersLaw) {
  const auto log_at = [](double elevation_deg) { return std::log(sunlight_klx(3, elevation_deg)); };
  EXPECT_NEAR((log_at(30) - log_at(90)) / (log_at(41.8103) - log_at(90)), 2, 0.05) << "air masses 2 and 1.5 against 1";
}

TEST(Rec709, OfWhiteIsOneAndColoursBeyondItAreCut) {
  const glm::dvec3 white = rec709_from({1, 0.3127, 0.3290});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(white[c], 1, 1e-3);
  EXPECT_EQ(rec709_from({1, 0.1, 0.7}).r, 0);
}

}  // namespace
}  // namespace catchlight::render
