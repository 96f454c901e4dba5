// The photographic operator and what it is found from, in closed form.
#include "catchlight/tone_curve.hpp"
#include "catchlight/color.hpp"
#include "render/tone/tone_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace catchlight::render::test {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// The histogram by frexp() instead of the float's bits.
LuminanceHistogram histogram_of(const std::vector<double>& luminances) {
  LuminanceHistogram histogram;
  for (const double luminance : luminances) {
    if (luminance < 0x1p-32) {
      ++histogram.bins[0].count;
      continue;
    }
    int exponent = 0;
    const double mantissa = 2 * std::frexp(luminance, &exponent) - 1, part = std::floor(mantissa * 64);
    LuminanceHistogram::Bin& bin = histogram.bins[static_cast<std::size_t>(1 + 64 * (exponent - 1 + 32) + part)];
    ++bin.count;
    bin.rest_low += static_cast<std::uint32_t>((mantissa * 64 - part) * 0x1p17);
  }
  return histogram;
}

SceneLuminance luminance_of(const std::vector<double>& luminances) {
  return scene_luminance(histogram_of(luminances));
}

TEST(SceneLuminanceOf, AConstantFrameIsItself) {
  for (const double luminance : {1e-6, 3e-4, 0.18, 1.0, 1000.0}) {
    const SceneLuminance found = luminance_of(std::vector<double>(100, luminance));
    EXPECT_NEAR(found.average / luminance, 1, 1e-6) << luminance;
    EXPECT_NEAR(found.low / luminance, 1, 1e-6);
    EXPECT_NEAR(found.high / luminance, 1, 1e-6);
  }
}

TEST(SceneLuminanceOf, TwoHalvesAreTheirGeometricMean) {
  std::vector<double> halves(1000, 0.1);
  std::fill_n(halves.begin(), 500, 0.4);
  // exp(mean(log(delta + L))) - delta with delta = 0.4e-3.
  EXPECT_NEAR(luminance_of(halves).average, std::sqrt(0.4004 * 0.1004) - 0.0004, 1e-6);
}

TEST(SceneLuminanceOf, ABlackFrameIsBlackAndItsCurveFinite) {
  const SceneLuminance black = luminance_of(std::vector<double>(100, 0.0));
  EXPECT_EQ(black.average, 0);
  const ToneCurve curve = tone_curve(black, {.enabled = true});
  EXPECT_EQ(curve.gain, 64);
  EXPECT_EQ(curve.white, 1);
  EXPECT_EQ(curve(0.0), 0);
}

TEST(SceneLuminanceOf, NoPixelAtAllIsBlack) {
  EXPECT_EQ(scene_luminance({}).average, 0);
}

TEST(SceneLuminanceOf, OneSunPixelHardlyCounts) {
  std::vector<double> grey(640 * 480, 0.18);
  const ToneCurve without = tone_curve(luminance_of(grey), {.enabled = true});
  grey[1234] = 1e9;
  const ToneCurve with = tone_curve(luminance_of(grey), {.enabled = true});
  EXPECT_NEAR(with.gain / without.gain, 1, 1e-4);
  EXPECT_EQ(with.white, without.white);
}

TEST(SceneLuminanceOf, OneSunPixelInTheDarkIsSane) {
  std::vector<double> dark(640 * 480, 0.0);
  dark[1234] = 1e9;
  const ToneCurve curve = tone_curve(luminance_of(dark), {.enabled = true});
  EXPECT_TRUE(std::isfinite(curve.gain) && std::isfinite(curve.white));
  EXPECT_GT(curve(1e9), 1);
}

TEST(SceneLuminanceOf, ScalesWithTheLight) {
  std::vector<double> scene;
  for (int i = 0; i < 997; ++i) scene.push_back(0.5 * std::exp(2 * std::sin(i * 1.7)));
  const SceneLuminance reference = luminance_of(scene);
  for (const int stops : {-8, -1, 3, 20}) {
    std::vector<double> scaled = scene;
    for (double& luminance : scaled) luminance = std::ldexp(luminance, stops);
    EXPECT_NEAR(luminance_of(scaled).average / std::ldexp(reference.average, stops), 1, 1e-12) << stops;
  }
}

TEST(ToneCurveOf, AFlatFrameBecomesTheKey) {
  for (const double luminance : {0.02, 0.18, 1.0, 5000.0})
    for (const double key : {0.09, 0.18, 0.72})
      EXPECT_NEAR(tone_curve({luminance, luminance, luminance}, {true, key})(luminance), key, 1e-12) << luminance;
}

TEST(ToneCurveOf, WithoutAWhitePointTheKeyBecomesKeyOverOneMore) {
  const ToneCurve curve = tone_curve({0.05, 0.001, 1}, {.enabled = true, .key = 0.72, .has_white_point = false});
  EXPECT_NEAR(curve(0.05), 0.72 / 1.72, 1e-12);
  EXPECT_LT(curve(1e9), 1);
}

TEST(ToneCurveOf, WhiteIsTheEstimateUpToTheFramesOwnHighlights) {
  // Ten stops: 1.5 * 2^5 = 48. The frame's highlight, exposed, lies below it in one frame and above it in the other.
  const ToneSettings settings{.enabled = true};
  EXPECT_NEAR(tone_curve({0.18, 0x1p-5, 0x1p5}, settings).white, 32, 1e-9);
  EXPECT_NEAR(tone_curve({0.045, 0x1p-5, 0x1p5}, settings).white, 48, 1e-9);
  EXPECT_EQ(tone_curve({0.18, 0.1, 0.9}, settings).white, 1) << "a picture that fits needs no compression";
}

TEST(ToneCurveShape, WhiteBecomesOne) {
  for (const double gain : {0.01, 1.0, 64.0})
    for (const double white : {1.0, 4.0, 300.0}) EXPECT_NEAR(ToneCurve(gain, white)(white / gain), 1, 1e-12);
}

TEST(ToneCurveShape, TheDefaultChangesNothing) {
  for (const double luminance : {0.0, 0.01, 0.18, 1.0, 50.0}) EXPECT_NEAR(ToneCurve{}(luminance), luminance, 1e-12);
}

TEST(ToneCurveShape, RisesEverywhere) {
  for (const double white : {1.0, 1.5, 10.0, kInfinite}) {
    double last = 0;
    for (double luminance = 1e-6; luminance < 1e6; luminance *= 1.01) {
      const double now = ToneCurve(1, white)(luminance);
      ASSERT_GT(now, last) << luminance << ", white " << white;
      last = now;
    }
  }
}

TEST(ToneCurveColor, KeepsItsRatio) {
  const glm::dvec3 light(0.4, 0.1, 0.2), toned = ToneCurve(3, 4)(light, kLuminanceWeights, true);
  EXPECT_NEAR(toned.r / toned.g, 4, 1e-12);
  EXPECT_NEAR(toned.r / toned.b, 2, 1e-12);
  EXPECT_NEAR(glm::dot(toned, kLuminanceWeights), ToneCurve(3, 4)(glm::dot(light, kLuminanceWeights)), 1e-12);
}

TEST(ToneCurveColor, BeyondTheCodesFadesToGreyOfItsLuminance) {
  const glm::dvec3 red(5, 0.1, 0.1);
  const ToneCurve curve(1, 10);
  const glm::dvec3 toned = curve(red, kLuminanceWeights, true);
  EXPECT_NEAR(toned.r, 1, 1e-12);
  EXPECT_NEAR(glm::dot(toned, kLuminanceWeights), curve(glm::dot(red, kLuminanceWeights)), 1e-12);
  EXPECT_GT(curve(red, kLuminanceWeights, false).r, 1) << "float codes go on";
  EXPECT_EQ(curve(glm::dvec3(1000), kLuminanceWeights, true), glm::dvec3(1));
}

TEST(ToneCurveColor, WhatIsNoLightIsFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const glm::dvec3& light : {glm::dvec3(nan), glm::dvec3(nan, 1, 1), glm::dvec3(kInfinite), glm::dvec3(-kInfinite, 1, 0)})
    for (const ToneCurve& curve : {ToneCurve{}, ToneCurve(64, kInfinite), ToneCurve(1e-9, 10)})
      for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(curve(light, kLuminanceWeights, true)[c]));
}

TEST(LuminanceWeightsOf, OtherPrimariesGiveTheSameLuminance) {
  const glm::mat3 plate_from_rec709(0.6f, 0.1f, 0.0f, 0.3f, 0.9f, 0.1f, 0.1f, 0.0f, 0.9f);
  const glm::dvec3 light(0.2, 0.5, 0.9);
  EXPECT_NEAR(glm::dot(luminance_weights(plate_from_rec709), glm::dmat3(plate_from_rec709) * light),
              glm::dot(kLuminanceWeights, light), 1e-12);
}

}  // namespace
}  // namespace catchlight::render::test
