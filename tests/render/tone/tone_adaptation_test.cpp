// Adaptation: the same curve at every frame rate, two speeds, no pumping.
#include "render/tone/tone_adaptation.hpp"
#include "catchlight/tone_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace catchlight::render::test {
namespace {

constexpr double kBright_s = 0.4, kDark_s = 1.6;
constexpr int kRates[] = {12, 24, 60, 240};

/// Gain at every twelfth of a second, of a scene that calls for `gain(time)`, filmed at `rate` frames a second.
std::vector<double> filmed(int rate, double duration_s, const std::function<double(double)>& gain) {
  ToneAdaptation adaptation(kBright_s, kDark_s);
  std::vector<double> curve;
  for (int frame = 0; frame <= duration_s * rate; ++frame) {
    const double time_s = static_cast<double>(frame) / rate;
    const ToneCurve wanted{gain(time_s), 1};
    const ToneCurve drawn = adaptation.at(time_s).value_or(wanted);
    adaptation.see(time_s, wanted);
    if (frame % (rate / 12) == 0) curve.push_back(drawn.gain);
  }
  return curve;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] / b[i] - 1));
  return largest;
}

TEST(ToneAdaptationRates, StepsGiveTheSameCurveAtEveryRate) {
  const auto steps = [](double time_s) { return time_s < 1 ? 4.0 : time_s < 3 ? 0.5 : 4.0; };
  const std::vector<double> reference = filmed(240, 8, steps);
  for (const int rate : kRates) EXPECT_LT(largest_difference(filmed(rate, 8, steps), reference), 1e-12) << rate;
  // And it is the curve that was promised.
  EXPECT_NEAR(std::log2(reference[12 + 6] / 0.5), 3 * std::exp(-0.5 / kBright_s), 1e-9);
  const double at_3 = std::log2(reference[36] / 4.0);
  EXPECT_NEAR(std::log2(reference[36 + 12] / 4.0), at_3 * std::exp(-1 / kDark_s), 1e-9);
}

TEST(ToneAdaptationRates, SlowDriftStaysWithinHalfAPercent) {
  const auto dusk = [](double time_s) { return std::exp2(-std::cos(2 * M_PI * time_s / 40)); };  // two stops in 20 s
  const std::vector<double> reference = filmed(240, 60, dusk);
  for (const int rate : kRates) EXPECT_LT(largest_difference(filmed(rate, 60, dusk), reference), 0.005) << rate;
}

TEST(ToneAdaptationRates, UnevenFramesGiveTheSameCurve) {
  ToneAdaptation even(kBright_s, kDark_s), uneven(kBright_s, kDark_s);
  for (ToneAdaptation* adaptation : {&even, &uneven}) {
    adaptation->see(0, {1, 1});
    adaptation->see(1, {0.1, 1});
  }
  for (const double time_s : {1.25, 1.5, 1.75}) even.see(time_s, {0.1, 1});
  for (const double time_s : {1.01, 1.7, 1.71}) uneven.see(time_s, {0.1, 1});
  EXPECT_NEAR(even.at(2)->gain, uneven.at(2)->gain, 1e-12);
}

TEST(ToneAdaptation, StartsAdapted) {
  ToneAdaptation adaptation(kBright_s, kDark_s);
  EXPECT_FALSE(adaptation.at(0));
  adaptation.see(-5, {3, 2});
  EXPECT_DOUBLE_EQ(adaptation.at(-5)->gain, 3);
  EXPECT_DOUBLE_EQ(adaptation.at(100)->gain, 3);
  EXPECT_DOUBLE_EQ(adaptation.at(100)->white, 2);
}

TEST(ToneAdaptation, GoesToBrightQuicklyAndToDarkSlowly) {
  const auto share_left = [](double from, double to) {
    ToneAdaptation adaptation(kBright_s, kDark_s);
    adaptation.see(0, {from, 1});
    adaptation.see(1, {to, 1});
    return std::log2(adaptation.at(1.4)->gain / to) / std::log2(from / to);
  };
  EXPECT_NEAR(share_left(8, 1), std::exp(-0.4 / kBright_s), 1e-12);
  EXPECT_NEAR(share_left(1, 8), std::exp(-0.4 / kDark_s), 1e-12);
}

TEST(ToneAdaptation, AFrameIsDrawnWithWhatWasBeforeIt) {
  ToneAdaptation adaptation(kBright_s, kDark_s);
  adaptation.see(0, {1, 1});
  adaptation.see(1, {0.1, 1});
  EXPECT_DOUBLE_EQ(adaptation.at(1)->gain, 1);
}

/// Alternating by +-x, the steady swing from peak to peak is 2 x r_b r_d / (r_b + r_d - r_b r_d) of r = 1 - exp(-dt / tau).
TEST(ToneAdaptation, AFlickeringSceneDoesNotPump) {
  const double x = 0.1, dt_s = 1.0 / 24;
  const std::vector<double> curve = [&] {
    ToneAdaptation adaptation(kBright_s, kDark_s);
    std::vector<double> gains;
    for (int frame = 0; frame < 480; ++frame) {
      gains.push_back(adaptation.at(frame * dt_s).value_or(ToneCurve{}).gain);
      adaptation.see(frame * dt_s, {frame % 2 ? 1 + x : 1 / (1 + x), 1});
    }
    return gains;
  }();
  const double bright = 1 - std::exp(-dt_s / kBright_s), dark = 1 - std::exp(-dt_s / kDark_s);
  const double swing = std::pow(1 + x, 2 * bright * dark / (bright + dark - bright * dark));
  EXPECT_NEAR(curve[478] / curve[479] > 1 ? curve[478] / curve[479] : curve[479] / curve[478], swing, 1e-9);
  EXPECT_LT(swing, 1.005) << "a flicker of 10 % moves the exposure by less than half a percent";
}

TEST(ToneAdaptation, TimeThatStandsOrRunsBackHolds) {
  ToneAdaptation adaptation(kBright_s, kDark_s);
  adaptation.see(5, {1, 1});
  adaptation.see(5, {0.1, 1});
  adaptation.see(4, {0.1, 1});
  EXPECT_DOUBLE_EQ(adaptation.at(3)->gain, 1);
  EXPECT_DOUBLE_EQ(adaptation.at(std::numeric_limits<double>::quiet_NaN())->gain, 1);
}

TEST(ToneAdaptation, NoTimeConstantIsTheNextFrame) {
  ToneAdaptation adaptation(0, 0);
  adaptation.see(0, {1, 1});
  adaptation.see(1, {0.25, 3});
  EXPECT_DOUBLE_EQ(adaptation.at(1)->gain, 1);
  EXPECT_DOUBLE_EQ(adaptation.at(1.04)->gain, 0.25);
  EXPECT_DOUBLE_EQ(adaptation.at(1.04)->white, 3);
}

TEST(ToneAdaptation, NoWhitePointStaysNone) {
  ToneAdaptation adaptation(kBright_s, kDark_s);
  const double none = std::numeric_limits<double>::infinity();
  adaptation.see(0, {1, none});
  adaptation.see(1, {2, none});
  EXPECT_EQ(adaptation.at(1.5)->white, none);
  EXPECT_TRUE(std::isfinite(adaptation.at(1.5)->gain));
}

}  // namespace
}  // namespace catchlight::render::test
