// What the glare passes must keep, whatever the picture.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "catchlight/image.hpp"
#include "render/gl/read_back.hpp"
#include "render/settings.hpp"
#include "tests/support/glare_fixture.hpp"
#include "tests/support/glare_scenes.hpp"

namespace catchlight::render::test {
namespace {

class GlarePassesGl : public GlTest {};

// Streaks: passes against a^k.

constexpr int kSize = 301, kMiddle = 150;

/// What the passes of one direction make of a single texel of light.
Image streak_of_a_point(const glm::dvec2& direction, double log_per_texel, int passes, float light) {
  ShaderLibrary shaders;
  StreakPass pass(shaders);
  const ColorTarget<1> source = make_glare_target("point", kSize, kSize), target = make_glare_target("streak", kSize, kSize);
  clear(source);
  clear(target);
  const float texel[4] = {light, light, light, 1};
  glTextureSubImage2D(source.texture().id(), 0, kMiddle, kMiddle, 1, 1, GL_RGBA, GL_FLOAT, texel);
  const std::array arms{streak_passes(direction, glm::dvec3(log_per_texel), passes, glm::dvec3(1))};
  pass.add(source.texture(), {kMiddle, kMiddle, 1, 1}, arms, target, {0, 0, kSize, kSize});
  return read_back(target.framebuffer(), 0, kSize, kSize, 3);
}

TEST_F(GlarePassesGl, StreakPassesComposeIntoAToTheK) {
  const double log_a = 2 * std::log(0.92);
  for (const int directions : {2, 4, 6, 8}) {
    for (const double rotation_deg : {0.0, 45.0, 20.0}) {
      for (const glm::dvec2& direction : streak_directions(directions, rotation_deg)) {
        const Image streak = streak_of_a_point(direction, log_a, 3, 1000.0f);
        const bool along_x = std::abs(direction.x) >= std::abs(direction.y);
        const double major = along_x ? direction.x : direction.y, minor = along_x ? direction.y : direction.x;
        for (int k = 0; k < 64; ++k) {
          // Across the streak, so that it does not matter between which texels it falls.
          double sum = 0, middle = 0;
          for (int j = 0; j < kSize; ++j) {
            const int along = kMiddle + (major > 0 ? k : -k);
            const double light = (along_x ? streak.pixel(along, j) : streak.pixel(j, along))[0];
            sum += light, middle += light * (j - kMiddle);
          }
          const double expected = 1000 * std::exp(log_a * k / std::abs(major));
          ASSERT_NEAR(sum / expected, 1, 1e-3) << directions << " directions turned by " << rotation_deg << ", step " << k;
          ASSERT_NEAR(middle / sum, k * minor / std::abs(major), 1e-3) << "it lies where it points, step " << k;
        }
      }
    }
  }
}

// Temporal stability: a highlight that moves by part of a pixel keeps its energy.

struct Range {
  double low = std::numeric_limits<double>::max(), high = 0;
  void add(double value) { low = std::min(low, value), high = std::max(high, value); }
  double spread() const { return high / low - 1; }
};

TEST_F(GlarePassesGl, AOnePixelHighlightKeepsItsEnergyWhileItMovesByAPixel) {
  ShaderLibrary shaders;
  GlarePass pass(GlareSettings{}, shaders);
  for (const float radiance : {30.0f, 100.0f, 1000.0f, 1e5f}) {
    for (const glm::dvec2 direction : {glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(1, 1)}) {
      Range energy;
      for (int i = 0; i <= 20; ++i) {
        const glm::dvec2 at = glm::dvec2(151, 222) + 0.05 * i * direction;
        const Glared result = glared(pass, one_pixel_highlight(320, 480, at.x, at.y, radiance));
        ASSERT_TRUE(result.any) << radiance;
        energy.add(sum_of(result.glare));
      }
      EXPECT_LT(energy.spread(), 0.01) << radiance << " towards " << direction.x << ", " << direction.y;
    }
  }
}

/// A 2 x 2 average weighted by 1 / (1 + luminance) (Karis 2013), the usual cure for flicker: the sum over its texels.
double energy_by_weighted_average(const Image& picture) {
  double energy = 0;
  for (int y = 0; y < picture.height; y += 2) {
    for (int x = 0; x < picture.width; x += 2) {
      double sum = 0, weights = 0;
      for (int i = 0; i < 4; ++i) {
        const double light = picture.pixel(x + i % 2, y + i / 2)[0];
        sum += light / (1 + light), weights += 1 / (1 + light);
      }
      energy += sum / weights;
    }
  }
  return energy;
}

TEST_F(GlarePassesGl, TheUsualWeightedAverageWouldFlicker) {
  Range energy;
  for (int i = 0; i <= 20; ++i) energy.add(energy_by_weighted_average(one_pixel_highlight(16, 16, 6 + 0.05 * i, 6, 1000)));
  EXPECT_GT(energy.spread(), 1) << "why the first filter is not that one";
}

/// Dim light all over, and two specks.
Image specks(int width, int height, int shift_px) {
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = 0.5f + 0.4f * std::sin(0.7f * float(x - shift_px) + 1.3f * float(y + c));
  for (int c = 0; c < 3; ++c) image.pixel(101 + shift_px, 77)[c] = 300, image.pixel(140 + shift_px, 90)[c] = 40;
  return image;
}

TEST_F(GlarePassesGl, WhichTexelsAreDrawnTogetherDoesNotShow) {
  // A shift by one texel of the grid moves the picture against the tiles; a low `brightest` lets the dim light around count.
  GlareSettings settings;
  settings.brightest = 2;
  settings.grid_rows = 120;
  ShaderLibrary shaders;
  GlarePass pass(settings, shaders);
  const Image here = glared(pass, specks(320, 240, 0)).excess;
  for (const int texels : {1, 2, 3}) {
    const Image there = glared(pass, specks(320, 240, 2 * texels)).excess;
    for (int y = 0; y < here.height; ++y)
      for (int x = 30; x < 120; ++x)
        ASSERT_NEAR(there.pixel(x + texels, y)[0], here.pixel(x, y)[0], 1e-4f) << x << ", " << y << " moved by " << texels;
  }
}

// Brightness depends on neither passes nor resolution.

TEST_F(GlarePassesGl, NeitherPassesNorDirectionsNorAttenuationChangeTheEnergyOfStreaks) {
  // Short streaks, so that none leaves the frame.
  const Image picture = one_pixel_highlight(640, 480, 320, 240, 1000);
  const auto energy = [&](int passes, int directions, double attenuation) {
    GlareSettings settings;
    settings.bloom_strength = 0;
    settings.streak_strength = 1;
    settings.streak_passes = passes;
    settings.streak_directions = directions;
    settings.streak_attenuation = attenuation;
    const Glared result = glared(settings, picture);
    return sum_of(result.glare) / sum_of(result.excess);
  };
  for (const int passes : {0, 1, 2, 3, 4}) EXPECT_NEAR(energy(passes, 4, 0.9), 1, 1e-3) << passes << " passes";
  for (const int directions : {1, 2, 3, 6, 16}) EXPECT_NEAR(energy(0, directions, 0.9), 1, 1e-3) << directions;
  for (const double attenuation : {0.0, 0.3, 0.8, 0.95}) EXPECT_NEAR(energy(0, 4, attenuation), 1, 2e-3) << attenuation;
}

TEST_F(GlarePassesGl, TheSamePictureGlaresAlikeAt480And720And1080Rows) {
  for (const NamedScene& scene : glare_scenes()) {
    const Image reference = glared(GlareSettings{}, scene.make(640, 480)).glare;
    const double peak = *std::max_element(reference.data.begin(), reference.data.end());
    for (const int rows : {720, 1080}) {
      const Image glare = glared(GlareSettings{}, scene.make(rows * 4 / 3, rows)).glare;
      ASSERT_EQ(glare.data.size(), reference.data.size());
      double largest = 0;
      for (std::size_t i = 0; i < glare.data.size(); ++i)
        largest = std::max<double>(largest, std::abs(glare.data[i] - reference.data[i]));
      EXPECT_LT(largest / peak, 0.02) << scene.name << " at " << rows;
      EXPECT_NEAR(sum_of(glare) / sum_of(reference), 1, 0.02) << scene.name << " at " << rows;
    }
  }
}

TEST_F(GlarePassesGl, TheSunDazzlesMuchMoreThanALampAndStaysFinite) {
  const auto peak = [](float radiance) {
    const Image glare = glared(GlareSettings{}, one_pixel_highlight(640, 480, 320, 240, radiance)).glare;
    return *std::max_element(glare.data.begin(), glare.data.end());
  };
  const float lamp = peak(100), sun = peak(1e5f), nova = peak(1e9f);
  EXPECT_GT(sun, 500 * lamp);
  EXPECT_GT(nova, sun);
  EXPECT_LT(nova, 100 * sun) << "compressed";
}

// Light sources and reflections.

TEST_F(GlarePassesGl, LightSourcesHaveStarsOfTheirOwn) {
  const Image reflected = one_pixel_highlight(640, 480, 160, 240, 1000), emitted = one_pixel_highlight(640, 480, 480, 240, 1000);
  Image both = reflected;
  for (std::size_t i = 0; i < both.data.size(); ++i) both.data[i] += emitted.data[i];
  GlareSettings settings;
  settings.bloom_strength = 0;
  settings.streak_directions = 2;
  settings.streak_rotation_deg = 90;
  settings.emitter_directions = 1;
  settings.emitter_strength = 0.5;
  const Glared result = glared(settings, both, &emitted);
  const auto at = [&](int x, int y) { return result.glare.pixel(x / 2 + 4, y / 2 + 4)[0]; };
  EXPECT_NEAR(at(160, 300) / at(160, 180), 1, 0.1) << "two arms for what is mirrored";
  EXPECT_NEAR(at(480, 300) / at(160, 300), 1, 0.01) << "one arm, twice as strong, for half the light";
  EXPECT_LT(std::abs(at(480, 180)), 1e-3 * at(480, 300));
}

TEST_F(GlarePassesGl, LightSourcesOfStrengthNothingDoNotGlare) {
  GlareSettings settings;
  settings.emitter_strength = 0;
  const Image lamp = one_pixel_highlight(640, 480, 320, 240, 1000), nothing(640, 480, 3);
  EXPECT_FALSE(glared(settings, lamp, &lamp).any);
  EXPECT_EQ(glared(settings, lamp, &nothing).glare.data, glared(settings, lamp).glare.data);
}

// Bad and extreme input.

Image filled(float value) {
  Image image(160, 120, 3);
  std::fill(image.data.begin(), image.data.end(), value);
  return image;
}

void expect_finite(const Image& image) {
  for (const float value : image.data) ASSERT_TRUE(std::isfinite(value) && std::abs(value) < 1e6f) << value;
}

TEST_F(GlarePassesGl, BlackAndWhiteFramesDoNotGlare) {
  EXPECT_FALSE(glared(GlareSettings{}, filled(0)).any);
  EXPECT_FALSE(glared(GlareSettings{}, filled(1)).any);
  EXPECT_TRUE(glared(GlareSettings{}, filled(1.1f)).any);
}

TEST_F(GlarePassesGl, ExposuresOfPlusAndMinusTwentyEvAreFinite) {
  for (const double ev : {-20.0, 20.0}) {
    Image picture = mirror_ball(160, 120);
    for (float& value : picture.data) value *= static_cast<float>(std::exp2(ev));
    const Glared result = glared(GlareSettings{}, picture);
    EXPECT_EQ(result.any, ev > 0);
    expect_finite(result.glare);
  }
}

TEST_F(GlarePassesGl, NanAndInfinityAndNegativeLightDoNotSpread) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kInf, -kInf, -1e30f, 1e30f}) {
    Image picture = one_pixel_highlight(160, 120, 40, 60, 1000);
    for (int c = 0; c < 3; ++c) picture.pixel(120, 60)[c] = bad;
    const Glared result = glared(GlareSettings{}, picture);
    ASSERT_TRUE(result.any);
    expect_finite(result.excess);
    expect_finite(result.glare);
    if (bad > 0) continue;
    EXPECT_EQ(result.glare.data, glared(GlareSettings{}, one_pixel_highlight(160, 120, 40, 60, 1000)).glare.data)
        << "NaN and what is below 0 counts as nothing";
  }
}

}  // namespace
}  // namespace catchlight::render::test
