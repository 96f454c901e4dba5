#include "render/probe/probe_split.hpp"
#include "catchlight/image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

namespace catchlight::render {
namespace {

constexpr double kPi = std::numbers::pi;

/// A disc in the sky.
struct Lamp {
  glm::dvec3 direction;
  double radius_rad;
  glm::vec3 radiance;
  double solid_angle() const { return 2 * kPi * (1 - std::cos(radius_rad)); }
};

/// Lamps over a dim sky, each texel the mean over its area.
Probe sky_with(const std::vector<Lamp>& lamps, int width = 512, ProbeLayout layout = ProbeLayout::latlong,
               const glm::vec3& sky = glm::vec3(0.1f)) {
  Probe probe{Image(width, layout == ProbeLayout::cube ? 6 * width : width / 2), layout};
  constexpr int kSub = 4;
  for (int y = 0; y < probe.image.height; ++y) {
    for (int x = 0; x < width; ++x) {
      glm::vec3 sum(0);
      for (int i = 0; i < kSub * kSub; ++i) {
        const double u = x + (i % kSub + 0.5) / kSub - 0.5, v = y + (i / kSub + 0.5) / kSub - 0.5;
        const auto direction = direction_from_texel(layout, width, probe.image.height, u, v);
        sum += sky;
        for (const Lamp& lamp : lamps)
          if (direction && glm::dot(*direction, lamp.direction) > std::cos(lamp.radius_rad)) sum += lamp.radiance;
      }
      for (int c = 0; c < 3; ++c) probe.image.pixel(x, y)[c] = sum[c] / (kSub * kSub);
    }
  }
  return probe;
}

glm::dvec3 towards(double latitude_deg, double longitude_deg) {
  const double a = latitude_deg * kPi / 180, b = longitude_deg * kPi / 180;
  return {std::cos(a) * std::sin(b), std::sin(a), std::cos(a) * std::cos(b)};
}

glm::dvec3 flux(const Probe& probe) {
  glm::dvec3 sum(0);
  for (int y = 0; y < probe.image.height; ++y)
    for (int x = 0; x < probe.image.width; ++x)
      for (int c = 0; c < 3; ++c)
        sum[c] += probe.image.pixel(x, y)[c] * texel_solid_angle(probe.layout, probe.image.width, probe.image.height, x, y);
  return sum;
}

glm::dvec3 flux(const std::vector<LightSample>& samples) {
  glm::dvec3 sum(0);
  for (const LightSample& sample : samples) sum += sample.irradiance;
  return sum;
}

double angle(const glm::dvec3& a, const glm::dvec3& b) {
  return std::acos(glm::clamp(glm::dot(a, b), -1.0, 1.0));
}

void expect_sums_to(const SplitProbe& split, const Probe& probe) {
  const glm::dvec3 whole = flux(probe), parts = flux(split.rest) + flux(samples_of(split, glm::dmat3(1.0)));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(parts[c], whole[c], 1e-6 * whole[c]);
}

TEST(ProbeSplit, FindsALampWhereItIsAsLargeAndBrightAsItIs) {
  const Lamp lamp{towards(40, 70), 0.05, {30, 20, 10}};
  const Probe probe = sky_with({lamp});
  const SplitProbe split = split_lights(probe, {});
  ASSERT_EQ(split.lights.size(), 1u);
  const ProbeLight& light = split.lights[0];
  EXPECT_LT(angle(light.direction, lamp.direction), 1e-3);
  EXPECT_GT(light.solid_angle_sr, lamp.solid_angle());
  const Lamp with_rim{lamp.direction, lamp.radius_rad + 2 * kPi / 512, lamp.radiance};
  EXPECT_LT(light.solid_angle_sr, with_rim.solid_angle()) << "the texels on its rim count whole";
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(light.irradiance[c], lamp.radiance[c] * lamp.solid_angle(), 0.06 * light.irradiance[c]);
  expect_sums_to(split, probe);
  for (const float value : split.rest.image.data) EXPECT_LT(value, 1.5 * split.threshold) << "no bright texel is left behind";
}

TEST(ProbeSplit, PartsSumToTheWholeInEveryLayout) {
  for (const ProbeLayout layout : {ProbeLayout::latlong, ProbeLayout::angular, ProbeLayout::cube, ProbeLayout::cube_cross}) {
    const Probe probe =
        convert(sky_with({{towards(50, 20), 0.08, {9, 9, 9}}, {towards(-30, 200), 0.04, {50, 20, 9}}}), layout, 192);
    const SplitProbe split = split_lights(probe, {});
    EXPECT_EQ(split.lights.size(), 2u) << name_of(layout);
    expect_sums_to(split, probe);
  }
}

TEST(ProbeSplit, OnlyLightsWithFineSamplesAreTakenOutOfMirrors) {
  const Lamp lamp{towards(40, 70), 0.04, glm::vec3(40)}, window{towards(20, -80), 0.5, glm::vec3(3)};
  const SplitProbe split = split_lights(sky_with({lamp, window}), {.max_samples = 6});
  ASSERT_EQ(split.lights.size(), 2u);
  for (const ProbeLight& light : split.lights) {
    EXPECT_EQ(light.compact, angle(light.direction, lamp.direction) < 0.1);
    for (const LightSample& of_it : light.samples) EXPECT_EQ(of_it.compact, light.compact);
  }
  EXPECT_LT(sample(split.mirrored, lamp.direction).g, 1.1 * split.threshold);
  EXPECT_NEAR(sample(split.mirrored, window.direction).g, 3.1, 0.01);
}

TEST(ProbeSplit, NeighbouringLampsStayTwoLights) {
  const double radius = 0.03;
  for (const double gap_deg : {6.0, 12.0}) {
    const SplitProbe split =
        split_lights(sky_with({{towards(30, 0), radius, glm::vec3(20)}, {towards(30, gap_deg), radius, glm::vec3(15)}}), {});
    EXPECT_EQ(split.lights.size(), 2u) << gap_deg;
  }
}

TEST(ProbeSplit, LampsInOneGlowStayTwoLights) {
  // A haze above the threshold joins them: the watershed still tells the peaks apart.
  const SplitProbe split = split_lights(sky_with({{towards(30, 5), 0.25, glm::vec3(1.5f)},
                                                  {towards(30, 0), 0.03, glm::vec3(40)},
                                                  {towards(30, 10), 0.03, glm::vec3(40)}}),
                                        {});
  ASSERT_GE(split.lights.size(), 2u);
  EXPECT_LT(angle(split.lights[0].direction, towards(30, 5)), 0.1);
  EXPECT_GT(angle(split.lights[0].direction, split.lights[1].direction), 0.1);
}

TEST(ProbeSplit, AWindowWithNoiseIsOneLight) {
  Probe probe = sky_with({{towards(20, 40), 0.2, glm::vec3(10)}});
  std::uint32_t state = 1;
  for (float& value : probe.image.data)
    value *= 0.75f + 0.5f * static_cast<float>((state = state * 1664525u + 1013904223u) >> 8) / (1 << 24);
  EXPECT_EQ(split_lights(probe, {}).lights.size(), 1u);
}

TEST(ProbeSplit, LightAcrossThePictureSeamOrAPoleIsOneLight) {
  for (const glm::dvec3& place : {towards(10, 180), towards(90, 0), towards(-90, 0)}) {
    const SplitProbe split = split_lights(sky_with({{place, 0.06, glm::vec3(20)}}), {});
    ASSERT_EQ(split.lights.size(), 1u);
    EXPECT_LT(angle(split.lights[0].direction, place), 2e-3);
  }
}

TEST(ProbeSplit, ASunDoesNotHideALamp) {
  // The sun is ten thousand times brighter than the lamp, which still holds twice the light of the sky.
  const SplitProbe split =
      split_lights(sky_with({{towards(50, 0), 0.0047, glm::vec3(3e4f)}, {towards(20, 120), 0.1, glm::vec3(40)}}, 1024,
                            ProbeLayout::latlong, glm::vec3(0.05f)),
                   {});
  EXPECT_EQ(split.lights.size(), 2u);
}

TEST(ProbeSplit, WhatTheBandsHoldIsNotSplitOff) {
  // Half of the sky is three times brighter than the other half.
  const Probe probe = sky_with({{towards(45, 0), kPi / 2, glm::vec3(0.2f)}});
  EXPECT_TRUE(split_lights(probe, {}).lights.empty());
}

TEST(ProbeSplit, AFaintLampIsNotWorthAShadowMap) {
  const Lamp lamp{towards(45, 0), 0.02, glm::vec3(1.5f)};  // 0.6 % of an average surface's light
  EXPECT_TRUE(split_lights(sky_with({lamp}), {.tolerance = 0.004}).lights.empty());
  EXPECT_EQ(split_lights(sky_with({lamp}), {.tolerance = 0.001}).lights.size(), 1u) << "but for a stricter eye it is";
}

TEST(ProbeSplit, ASunOfOneTexelBeyondHalfFloat) {
  Probe probe = sky_with({});
  for (int c = 0; c < 3; ++c) probe.image.pixel(100, 60)[c] = 1e6f;
  const SplitProbe split = split_lights(probe, {});
  ASSERT_EQ(split.lights.size(), 1u);
  EXPECT_GT(split.lights[0].samples.size(), 4u) << "its texel is an area";
  EXPECT_LT(angle(split.lights[0].direction, *direction_from_texel(probe.layout, 512, 256, 100, 60)), 1e-4);
  expect_sums_to(split, probe);
}

TEST(ProbeSplit, ABlackOrEvenProbeHasNoLights) {
  EXPECT_TRUE(split_lights(Probe{Image(64, 32)}, {}).lights.empty());
  EXPECT_TRUE(split_lights(sky_with({}), {}).lights.empty());
}

TEST(ProbeSplit, ATinyProbeWorks) {
  Probe probe = sky_with({}, 16);
  ASSERT_EQ(probe.image.height, 8);
  probe.image.pixel(5, 2)[1] = 100;
  for (const int bands : {5, 7, 10}) {
    const SplitProbe split = split_lights(probe, {.bands = bands});
    ASSERT_EQ(split.lights.size(), 1u) << "22 degrees wide, with edges that no " << bands << " bands hold";
    expect_sums_to(split, probe);
  }
}

TEST(ProbeSplit, KeepsToItsBudgetAndCanBeTurnedOff) {
  std::vector<Lamp> lamps;
  for (int i = 0; i < 12; ++i) lamps.push_back({towards(-50 + 10 * (i % 3) * 4, 30 * i), 0.05, glm::vec3(20.0f + i)});
  const Probe probe = sky_with(lamps);
  for (const int budget : {1, 5, 12, 40, 96}) {
    const SplitProbe split = split_lights(probe, {.max_samples = budget});
    EXPECT_LE(samples_of(split, glm::dmat3(1.0)).size(), static_cast<std::size_t>(budget));
    EXPECT_GE(samples_of(split, glm::dmat3(1.0)).size(), std::min<std::size_t>(budget, 12) * 3 / 4);
    expect_sums_to(split, probe);
  }
  EXPECT_TRUE(split_lights(probe, {.max_samples = 0}).lights.empty());
}

TEST(ProbeSplit, SamplesLightASurfaceAsTheLampDoes) {
  // A disc light's irradiance on surfaces that see all of it is pi sin^2(r) cos: no sample's place may be off.
  const Lamp lamp{towards(60, 30), 0.2, glm::vec3(10)};
  const std::vector<LightSample> samples = samples_of(split_lights(sky_with({lamp}, 1024), {}), glm::dmat3(1.0));
  ASSERT_GT(samples.size(), 16u);
  const glm::dvec3 aside = glm::normalize(glm::cross(lamp.direction, glm::dvec3(0, 1, 0)));
  double sum = 0;
  for (const double tilt : {0.0, 0.5, 1.0, 1.3}) {
    const glm::dvec3 normal = std::cos(tilt) * lamp.direction + std::sin(tilt) * aside;
    double irradiance = 0;
    for (const LightSample& sample : samples)
      irradiance += sample.irradiance.g * std::max(glm::dot(sample.direction, normal), 0.0);
    const double expected = kPi * std::pow(std::sin(lamp.radius_rad), 2) * std::cos(tilt) * (lamp.radiance.g + 0.1 - 0.5);
    EXPECT_NEAR(irradiance, expected, 0.02 * kPi * std::pow(std::sin(lamp.radius_rad), 2) * lamp.radiance.g) << tilt;
    sum += irradiance;
  }
  EXPECT_GT(sum, 0);
}

TEST(ProbeSplit, SamplesFollowTheProbesTurn) {
  const SplitProbe split = split_lights(sky_with({{towards(40, 10), 0.1, glm::vec3(10)}}), {});
  const glm::dmat3 rotation = tag_from_probe(UpAxis::z, 25);
  const std::vector<LightSample> turned = samples_of(split, rotation), still = samples_of(split, glm::dmat3(1.0));
  for (std::size_t i = 0; i < still.size(); ++i)
    EXPECT_LT(glm::length(turned[i].direction - rotation * still[i].direction), 1e-12);
}

TEST(LightSamples, HalvesHoldTheSameLight) {
  std::vector<LightPiece> pieces;
  for (int i = 0; i < 1000; ++i) {
    const double x = (i % 40 - 20) / 100.0, y = (i / 40 - 12) / 100.0;
    pieces.push_back({glm::normalize(glm::dvec3(x, y, 1)), glm::dvec3(1 + 10 * (x > 0.1)), 1e-4});
  }
  const double total = flux(median_cut(pieces, 1)).g;
  for (const int count : {2, 7, 16}) {
    const std::vector<LightSample> samples = median_cut(pieces, count);
    ASSERT_EQ(samples.size(), static_cast<std::size_t>(count));
    EXPECT_NEAR(flux(samples).g, total, 1e-9);
    for (const LightSample& sample : samples) EXPECT_NEAR(sample.irradiance.g, total / count, 0.15 * total / count);
  }
}

TEST(LightSamples, SpreadIsThatOfTheLight) {
  // A square of half side a has the variance a^2 / 3 along each axis.
  std::vector<LightPiece> pieces;
  const double half = 0.05;
  for (int i = 0; i < 400; ++i) {
    const glm::dvec2 p = half * (glm::dvec2(i % 20, i / 20) + 0.5 - 10.0) / 10.0;
    pieces.push_back({glm::normalize(glm::dvec3(p, 1)), glm::dvec3(1), std::pow(half / 10, 2)});
  }
  EXPECT_NEAR(median_cut(pieces, 1)[0].spread_rad, half / std::sqrt(3.0), 0.01 * half);
}

TEST(LightSamples, NoMoreThanThereArePieces) {
  const LightPiece piece{{0, 0, 1}, glm::dvec3(1), 1e-3};
  EXPECT_EQ(median_cut({piece}, 5).size(), 1u);
  EXPECT_EQ(median_cut({piece, piece, piece}, 5).size(), 3u) << "even where all lie in one place";
}

/// Debian's blender-data: eight probes of rooms, suns and lamps.
class StudioLights : public ::testing::TestWithParam<const char*> {};

TEST_P(StudioLights, PartsSumToTheWholeAndWhatIsLeftIsSmooth) {
  const std::filesystem::path file =
      std::filesystem::path("/usr/share/blender/datafiles/studiolights/world") / (std::string(GetParam()) + ".exr");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not installed";
  const Probe probe = load_probe(file, {}, {});
  const SplitProbe split = split_lights(probe, {});
  expect_sums_to(split, probe);
  EXPECT_FALSE(split.lights.empty());
}

INSTANTIATE_TEST_SUITE_P(Debian, StudioLights,
                         ::testing::Values("city", "courtyard", "forest", "interior", "night", "studio", "sunrise", "sunset"));

}  // namespace
}  // namespace catchlight::render
