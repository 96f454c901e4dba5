// Probes at the ends of what users have: suns beyond half, no light at all, hardly a texel, hundreds of thousands.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "catchlight/image.hpp"
#include "render/image/image_io.hpp"
#include "render/probe/prefilter.hpp"
#include "render/probe/probe.hpp"
#include "tests/support/test_files.hpp"

namespace catchlight::render {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr float kSun = 3e8f;  // the sun's disc beside a sky of 1, and beyond

Probe sunny(int width, int height) {
  Probe probe{Image(width, height), ProbeLayout::latlong};
  std::fill(probe.image.data.begin(), probe.image.data.end(), 1.0f);
  for (int c = 0; c < 3; ++c) probe.image.pixel(width / 3, height / 4)[c] = kSun;
  return probe;
}

bool is_finite(const Image& image) {
  return std::all_of(image.data.begin(), image.data.end(), [](float value) { return std::isfinite(value); });
}

/// Finite everywhere, and as much light as the closed form has: the sky's pi and the sun's cosine.
void expect_sane(const Probe& probe, double sun, double tolerance) {
  const int x = probe.image.width / 3, y = probe.image.height / 4;
  const double solid_angle_sr = texel_solid_angle(probe.layout, probe.image.width, probe.image.height, x, y);
  const glm::dvec3 towards = *direction_from_texel(probe.layout, probe.image.width, probe.image.height, x, y);
  const double expected = kPi + sun * solid_angle_sr * towards.y;
  EXPECT_NEAR(irradiance(probe, {0, 1, 0}).g / expected, 1, tolerance);
  for (const glm::vec3& coefficient : project_to_sh(probe, 10))
    EXPECT_TRUE(std::isfinite(coefficient.r) && std::isfinite(coefficient.g) && std::isfinite(coefficient.b));
  for (const Image& level : prefilter_reflections(probe, glm::dmat3(1), 64).levels) EXPECT_TRUE(is_finite(level));
}

class ProbeExtremes : public testing::Test {
 protected:
  TempFolder folder;
};

TEST_F(ProbeExtremes, SunBeyondHalfSurvivesBothFormatsAndAllThatIsMadeOfIt) {
  for (const char* name : {"sun.exr", "sun.hdr"}) {
    save_probe(folder / name, sunny(128, 64));
    const Probe probe = load_probe(folder / name, {}, [](const std::string& warning) { ADD_FAILURE() << warning; });
    EXPECT_NEAR(probe.image.pixel(42, 16)[0] / kSun, 1, 1.0 / 256) << name;
    expect_sane(probe, kSun, 1.0 / 256);
  }
}

TEST_F(ProbeExtremes, SunBeyondHalfSurvivesEveryLayout) {
  const Probe probe = sunny(128, 64);
  const double up = irradiance(probe, {0, 1, 0}).g;
  for (const ProbeLayout layout : {ProbeLayout::angular, ProbeLayout::mirror_ball, ProbeLayout::cube_cross, ProbeLayout::cube}) {
    const Probe there = convert(probe, layout), back = convert(there, ProbeLayout::latlong, 128);
    EXPECT_TRUE(is_finite(there.image) && is_finite(back.image));
    // One texel becomes a few, each at its own cosine: within the square of a texel's angle, and the averaging's own error.
    EXPECT_NEAR(irradiance(back, {0, 1, 0}).g / up, 1, 0.05) << name_of(layout);
  }
}

TEST_F(ProbeExtremes, BlackProbeLightsNothingAndStaysFinite) {
  const Probe black{Image(16, 8), ProbeLayout::latlong};
  EXPECT_EQ(irradiance(black, {0, 1, 0}), glm::dvec3(0));
  for (const glm::vec3& coefficient : project_to_sh(black, 10)) EXPECT_EQ(coefficient, glm::vec3(0));
  for (const Image& level : prefilter_reflections(black, glm::dmat3(1), 64).levels)
    for (const float value : level.data) ASSERT_EQ(value, 0.0f);
  for (const ProbeLayout layout : {ProbeLayout::angular, ProbeLayout::mirror_ball, ProbeLayout::cube_cross, ProbeLayout::cube})
    for (const float value : convert(black, layout).image.data) ASSERT_EQ(value, 0.0f);
}

TEST_F(ProbeExtremes, SixteenByEightTexelsAreAProbe) {
  expect_sane(sunny(16, 8), kSun, 1e-3);
}

/// The same sun and sky at 4096 x 2048: sums over eight million texels lose nothing to rounding.
TEST_F(ProbeExtremes, ManyTexelsSumAsFewDo) {
  const Probe probe = sunny(4096, 2048);
  const double solid_angle_sr = texel_solid_angle(probe.layout, 4096, 2048, 1365, 512);
  const glm::dvec3 towards = *direction_from_texel(probe.layout, 4096, 2048, 1365, 512);
  EXPECT_NEAR(irradiance(probe, {0, 1, 0}).r / (kPi + kSun * solid_angle_sr * towards.y), 1, 1e-5);
  const double c0 = std::sqrt(1 / (4 * kPi)) * (4 * kPi + (kSun - 1) * solid_angle_sr);
  EXPECT_NEAR(project_to_sh(probe, 1)[0].r / c0, 1, 1e-6);
}

}  // namespace
}  // namespace catchlight::render
