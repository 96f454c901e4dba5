// Tone and the classic look on processors, where closed forms say what they give; cpu_tone_gl_test holds them against a card's.
#include "render/cpu/tone/cpu_tone.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "catchlight/color.hpp"
#include "catchlight/image.hpp"
#include "catchlight/plate.hpp"
#include "render/cpu/glare/classic_glare.hpp"
#include "render/settings.hpp"

namespace catchlight::render::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

Image grey(int width, int height, float light) {
  Image image(width, height, 4);
  std::fill(image.data.begin(), image.data.end(), light);
  return image;
}

void set(Image& image, int x, int y, float light) {
  std::fill_n(image.pixel(x, y), 3, light);
}

CompositorSettings automatic() {
  CompositorSettings settings;
  settings.tone.enabled = true;
  return settings;
}

Image coded(Image light, const CompositorSettings& settings, TransferFunction transfer = TransferFunction::linear) {
  PlateColor color;
  color.transfer = transfer;
  CpuTone tone(settings);
  tone.apply(light, color, tone.meter(light, color), true);
  return light;
}

TEST(CpuTone, AFlatPictureBecomesTheKey) {
  for (const float light : {0.004f, 0.05f, 0.9f}) {
    const Image codes = coded(grey(161, 119, light), automatic());
    EXPECT_NEAR(codes.pixel(160, 118)[1], 0.18, 1e-5) << light;
    EXPECT_EQ(codes.pixel(0, 0)[3], 1);
  }
  EXPECT_NEAR(coded(grey(16, 12, 0.3f), automatic(), TransferFunction::srgb).pixel(3, 3)[0], srgb_from_linear(0.18), 1e-5);
}

TEST(CpuTone, NanCountsForNothingAndInfinityForTheMost) {
  Image image = grey(20, 10, 0.18f);
  image.pixel(0, 0)[0] = kNan;
  set(image, 19, 9, kInf);
  set(image, 5, 5, -3);
  const LuminanceHistogram histogram = measure_luminances(image, kLuminanceWeights);
  std::uint32_t pixels = 0;
  for (const auto& bin : histogram.bins) pixels += bin.count;
  EXPECT_EQ(pixels, 199u);
  EXPECT_EQ(histogram.bins.front().count, 1u) << "what is darker than black is black";
  EXPECT_EQ(histogram.bins.back().count, 1u);
}

TEST(CpuTone, CountsEveryPixelIntoTheBinThatHoldsIt) {
  Image image(641, 479, 4);
  std::mt19937 random(7);
  std::normal_distribution<double> stops(-2, 5);
  std::vector<double> luminances;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      set(image, x, y, static_cast<float>(std::exp2(stops(random))));
      luminances.push_back(image.pixel(x, y)[0]);
    }
  const LuminanceHistogram histogram = measure_luminances(image, {0, 1, 0});
  std::ranges::sort(luminances);
  auto next = luminances.begin();
  for (int bin = 0; bin < LuminanceHistogram::kBins; ++bin) {
    const std::uint32_t count = histogram.bins[static_cast<std::size_t>(bin)].count;
    if (count == 0) continue;
    double sum = 0;
    for (std::uint32_t i = 0; i < count; ++i) sum += *next++;
    ASSERT_NEAR(histogram.mean(bin), bin > 0 ? sum / count : 0, 1e-12 * sum) << bin;
  }
  EXPECT_EQ(next, luminances.end());
}

TEST(CpuTone, TheSumOfHistogramsIsThatOfAllPixels) {
  LuminanceHistogram whole, part;
  std::array<LuminanceHistogram, 2> parts;
  for (std::uint32_t i = 0; i < 200000; ++i) whole.add(1.999f), parts[i % 2].add(1.999f);
  part.add(parts[0]);
  part.add(parts[1]);
  for (int bin = 0; bin < LuminanceHistogram::kBins; ++bin) {
    const auto at = static_cast<std::size_t>(bin);
    ASSERT_EQ(part.bins[at].count, whole.bins[at].count);
    EXPECT_EQ(part.bins[at].rest_low, whole.bins[at].rest_low);
    EXPECT_EQ(part.bins[at].rest_high, whole.bins[at].rest_high) << "sums beyond 32 bits";
  }
}

TEST(CpuTone, BadLightGivesCodes) {
  CompositorSettings settings = automatic();
  for (const Look look : {Look::camera, Look::classic}) {
    settings.look = look;
    for (const float bad : {kNan, kInf, -kInf, 1e30f}) {
      Image light = grey(64, 48, 0.3f);
      set(light, 9, 9, bad);
      for (const float code : coded(light, settings).data) ASSERT_TRUE(code >= 0 && code <= 1) << code << " of " << bad;
    }
  }
}

TEST(CpuTone, WithoutToneAndGlareLightIsCodedAsItIs) {
  CompositorSettings settings;
  settings.look = Look::classic;
  settings.glare.enabled = false;
  EXPECT_NEAR(coded(grey(16, 12, 0.4f), settings, TransferFunction::srgb).pixel(5, 5)[2], srgb_from_linear(0.4), 1e-6);
}

// The classic look's glare.

double sum_of(const GlarePicture& picture) {
  double sum = 0;
  for (int y = 0; y < picture.rows(); ++y)
    for (int x = picture.lit(y).begin; x < picture.lit(y).end; ++x) sum += picture.row(y)[x][1];
  return sum;
}

float at(const GlarePicture& picture, int x, int y) {
  const Span lit = picture.lit(y);
  return x >= lit.begin && x < lit.end ? picture.row(y)[x][1] : 0;
}

TEST(ClassicGlare, NothingOverTheThresholdGivesNothing) {
  ClassicGlare glare(GlareSettings{});
  glare.draw(grey(64, 48, 1));
  EXPECT_EQ(sum_of(glare.bloom()), 0);
  EXPECT_EQ(sum_of(glare.streaks()), 0);
}

TEST(ClassicGlare, AMovingHighlightKeepsItsEnergyInThreeGaussians) {
  ClassicGlare glare(GlareSettings{});
  for (int x = 900; x < 910; ++x) {
    Image light(1920, 1080, 4);
    set(light, x, 500, 51);
    glare.draw(light);
    const double bright = 50 / (1920.0 / 512 * 1080 / 512);  // what exceeds white, in texels
    EXPECT_NEAR(sum_of(glare.bright()) / bright, 1, 1e-5) << x;
    EXPECT_NEAR(sum_of(glare.bloom()) / bright, 3, 1e-4) << x;
  }
}

TEST(ClassicGlare, StreaksFallAsAPowerAlongTheDiagonals) {
  GlareSettings settings;
  settings.streak_attenuation = 0.98;
  ClassicGlare glare(settings);
  Image light(512, 512, 4);
  for (int i = 0; i < 16; ++i) set(light, 256 + i % 4, 240 + i / 4, 41);  // one texel of 128: (64, 60)
  glare.draw(light);
  const double a = classic_attenuation(0.98);
  for (int k = 1; k < 60; ++k)
    for (const int dx : {-1, 1})
      for (const int dy : {-1, 1}) {
        EXPECT_NEAR(at(glare.streaks(), 64 + k * dx, 60 + k * dy) / (0.25 * 40 * std::pow(a, k)), 1, 1e-4) << k;
        EXPECT_EQ(at(glare.streaks(), 64 + k * dx, 60), 0);
      }
}

TEST(ClassicGlare, DoesNotRememberTheFrameBefore) {
  ClassicGlare kept(GlareSettings{});
  for (const int x : {10, 200, 310, 15}) {
    Image light(320, x == 310 ? 240 : 241, 4);
    set(light, x, 100, 30);
    ClassicGlare fresh(GlareSettings{});
    kept.draw(light);
    fresh.draw(light);
    for (int y = 0; y < light.height; ++y) {
      std::vector<Float4> again(320), anew(320);
      kept.add_to_row(y, again.data());
      fresh.add_to_row(y, anew.data());
      for (std::size_t i = 0; i < again.size(); ++i)
        for (int c = 0; c < 3; ++c) ASSERT_EQ(again[i][c], anew[i][c]) << i << ", " << y;
    }
  }
}

}  // namespace
}  // namespace catchlight::render::test
