#include "render/made_probe/made_probe.hpp"
#include "catchlight/color.hpp"
#include "render/probe/probe_split.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace catchlight::render {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using tests::message_of;

const glm::dvec3 kUp(0, 1, 0);

/// The direction at these angles; azimuth is counted from -z over +x.
glm::dvec3 direction_at(double elevation_deg, double azimuth_deg) {
  const double elevation = glm::radians(elevation_deg), azimuth = glm::radians(azimuth_deg);
  return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation), -std::cos(elevation) * std::cos(azimuth)};
}

class EveryMadeProbe : public ::testing::TestWithParam<const char*> {};

// The furnace's balance: what leaves the ground is its albedo's share of what reaches it.
TEST_P(EveryMadeProbe, LightsWhiteByOneOverAGroundInThatLight) {
  const Probe probe = make_probe(GetParam());
  const glm::dvec3 white = irradiance(probe, kUp) / glm::pi<double>();
  EXPECT_NEAR(glm::dot(kLuminanceWeights, white), 1, 1e-5);
  const glm::dvec3 albedo = irradiance(probe, -kUp) / glm::pi<double>() / white;
  EXPECT_NEAR(albedo.r, 0.2, 1e-4);
  EXPECT_NEAR(albedo.g, albedo.r, 1e-5);
  EXPECT_NEAR(albedo.b, albedo.r, 1e-5);
  for (const float value : probe.image.data) ASSERT_TRUE(std::isfinite(value) && value > 0);
}

TEST_P(EveryMadeProbe, IsTheSameOnEveryCallAndFromAFile) {
  const tests::TemporaryFolder folder;
  const Probe probe = make_probe(GetParam());
  save_probe(folder.path("made.exr"), probe, ExrPrecision::full);
  EXPECT_TRUE(make_probe(GetParam()).image.data == probe.image.data);
  const Probe read = load_probe(folder.path("made.exr"), {.layout = std::nullopt, .strict = true}, {});
  EXPECT_EQ(read.layout, ProbeLayout::latlong);
  EXPECT_TRUE(read.image.data == probe.image.data);
}

INSTANTIATE_TEST_SUITE_P(Names, EveryMadeProbe,
                         ::testing::Values("overcast", "studio", "sky", "sky:sun_elevation_deg=0,turbidity=10",
                                           "sky:sun_elevation_deg=90,turbidity=2", "sky:sun_azimuth_deg=0"));

TEST(Overcast, IsTheCiesClosedForm) {
  const Probe probe = make_probe("overcast");
  // Its irradiance is 7 pi / 9 of the zenith's luminance: pi here.
  const double zenith = 9.0 / 7;
  for (const double elevation_deg : {1.0, 20.0, 45.0, 70.0, 89.9})
    for (const double azimuth_deg : {0.0, 100.0, 250.0}) {
      const double expected = zenith * (1 + 2 * std::sin(glm::radians(elevation_deg))) / 3;
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(sample(probe, direction_at(elevation_deg, azimuth_deg))[c], expected, 1e-4 * expected) << elevation_deg;
    }
  EXPECT_TRUE(split_lights(probe, {7, 0.004, 96}).lights.empty());
}

TEST(Studio, HasAKeyOnTheLeftThatOutshinesFillAndRim) {
  const Probe probe = make_probe("studio");
  const double left = irradiance(probe, {-1, 0, 0}).g, right = irradiance(probe, {1, 0, 0}).g;
  EXPECT_GT(left, 1.6 * right);
  EXPECT_GT(irradiance(probe, {0, 0, 1}).g, irradiance(probe, {0, 0, -1}).g) << "more comes from the camera's side";
  const auto [least, most] = std::ranges::minmax(probe.image.data);
  EXPECT_GT(most / least, 100);
}

/// What the sun adds, by its brightest place's surroundings.
struct Sun {
  glm::dvec3 irradiance{0}, towards{0};
};
Sun sun_in(const Probe& probe, const glm::dvec3& about) {
  Sun sun;
  const Image& image = probe.image;
  const glm::vec3 sky = sample(probe, glm::normalize(about + 0.02 * glm::normalize(glm::cross(about, kUp))));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const glm::dvec3 direction = *direction_from_texel(probe.layout, image.width, image.height, x, y);
      if (glm::dot(direction, about) < std::cos(glm::radians(1.2))) continue;
      const double solid_angle_sr = texel_solid_angle(probe.layout, image.width, image.height, x, y);
      for (int c = 0; c < 3; ++c)
        sun.irradiance[c] += solid_angle_sr * glm::dot(direction, about) * (image.pixel(x, y)[c] - sky[c]);
      sun.towards += solid_angle_sr * (image.pixel(x, y)[1] - sky.g) * direction;
    }
  sun.towards = glm::normalize(sun.towards);
  return sun;
}

// Where texels are wide, narrow, at the seam and across it, the disc brings the same light, towards the same place.
TEST(Sky, SunHasItsEnergyAndPlaceWhereverTexelsLie) {
  for (const double elevation_deg : {20.0, 50.0, 80.0}) {
    const std::string elevation = "sky:sun_elevation_deg=" + std::to_string(elevation_deg);
    const Sun reference = sun_in(make_probe(elevation + ",sun_azimuth_deg=90"), direction_at(elevation_deg, 90));
    for (const double azimuth_deg : {0.0, 0.13, 90.1, 180.0, 200.26}) {
      const Sun sun = sun_in(make_probe(elevation + ",sun_azimuth_deg=" + std::to_string(azimuth_deg)),
                             direction_at(elevation_deg, azimuth_deg));
      EXPECT_NEAR(sun.irradiance.g / reference.irradiance.g, 1, 0.005) << elevation_deg << ' ' << azimuth_deg;
      EXPECT_LT(glm::degrees(glm::distance(sun.towards, direction_at(elevation_deg, azimuth_deg))), 0.03)
          << elevation_deg << ' ' << azimuth_deg;
    }
  }
}

TEST(Sky, OfADateHasTheSunOfThatHour) {
  // Where the Astronomical Almanac has it at the winter solstice's noon in Greenwich: in the south, 90 - 51.48 - 23.44 high.
  const std::string date = "sky:date=2026-12-21T11:58Z,latitude_deg=51.48,longitude_deg=0";
  const Probe by_date = make_probe(date);
  EXPECT_LT(glm::degrees(glm::distance(sun_in(by_date, direction_at(15.08, 180)).towards, direction_at(15.08, 180))), 0.1);
  EXPECT_TRUE(make_probe("sky:date=2026-12-21T12:58+01:00,latitude_deg=51.48,longitude_deg=0").image.data == by_date.image.data);
}

TEST(Sky, LowSunIsRedderAndHazeTakesFromIt) {
  const auto sun = [](const std::string& values, double elevation_deg) {
    return sun_in(make_probe("sky:sun_azimuth_deg=90," + values), direction_at(elevation_deg, 90)).irradiance;
  };
  const glm::dvec3 high = sun("sun_elevation_deg=60", 60), low = sun("sun_elevation_deg=8", 8);
  EXPECT_GT(low.r / low.b, 2 * high.r / high.b);
  EXPECT_LT(sun("sun_elevation_deg=60,turbidity=8", 60).g, 0.7 * high.g);
}

struct Refusal {
  const char* name;
  const char* why;
};
class Refused : public ::testing::TestWithParam<Refusal> {};

TEST_P(Refused, NameIsSaidWithTheReason) {
  const auto& [name, why] = GetParam();
  EXPECT_THAT(message_of<Error>([&] { make_probe(name); }), AllOf(StartsWith(std::string(name) + ": "), HasSubstr(why)));
}

INSTANTIATE_TEST_SUITE_P(
    Names, Refused,
    ::testing::Values(Refusal{"studo", "did you mean \"studio\"? There are \"overcast\", \"studio\" or \"sky\""},
                      Refusal{"overcast:turbidity=3", "did you mean \"overcast\"?"},
                      Refusal{"sky:", "\"\" is no value; expected KEY=VALUE"},
                      Refusal{"sky:turbidty=3", "there is no \"turbidty\"; did you mean \"turbidity\"?"},
                      Refusal{"sky:turbidity=1", "turbidity is 1; expected a number from 2 to 10"},
                      Refusal{"sky:turbidity=nan", "turbidity is nan"},
                      Refusal{"sky:turbidity=3,turbidity=4", "turbidity is given twice"},
                      Refusal{"sky:sun_elevation_deg=-4",
                              "expected a number from 0 to 90; the sky's model has its sun above the horizon; "
                              "\"overcast\" is nearer to what dusk is like"},
                      Refusal{"sky:date=2026-06-21T23:00Z,latitude_deg=48,longitude_deg=11", "below the horizon then and there"},
                      Refusal{"sky:date=21.6.2026,latitude_deg=48,longitude_deg=11", "such as 2026-06-21T12:00Z"},
                      Refusal{"sky:date=2026-06-21T12:00Z,latitude_deg=48", "a date needs latitude_deg and longitude_deg"},
                      Refusal{"sky:date=2026-06-21T12:00Z,latitude_deg=98,longitude_deg=11",
                              "latitude_deg is 98; expected a number from -90 to"},
                      Refusal{"sky:date=2026-06-21T12:00Z,latitude_deg=48,longitude_deg=11,sun_elevation_deg=20",
                              "leave out sun_elevation_deg"},
                      Refusal{"sky:latitude_deg=48", "latitude_deg needs a date"}));

}  // namespace
}  // namespace catchlight::render
