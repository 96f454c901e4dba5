// The arithmetic under the glare passes; no GL.
#include "render/glare/glare_plan.hpp"
#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "render/glare/glare_kernel.hpp"
#include "render/glare/tile_mask.hpp"
#include "render/settings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace catchlight::render::test {
namespace {

TEST(GlarePlan, GridHasTheSameRowsWhateverTheFrame) {
  for (const int rows : {240, 480, 720, 1080, 2160, 4321}) EXPECT_EQ(make_glare_grid(rows, rows, 240).rows, 240 + 8) << rows;
  EXPECT_EQ(make_glare_grid(160, 120, 240).rows, 120 + 8) << "no texel is smaller than a pixel";
  EXPECT_EQ(make_glare_grid(1, 1, 240).columns, 1 + 8);
}

TEST(GlarePlan, TexelsAndPixelsCoverEachOther) {
  const GlareGrid grid = make_glare_grid(1920, 1080, 240);
  const PixelRect pixels{17, 1000, 5, 3}, back = grid.pixels(grid.texels(pixels, 0));
  EXPECT_EQ(unite(back, pixels), back);
  EXPECT_LE(back.width, pixels.width + 10);
}

TEST(GlarePlan, EveryBlurHasItsWeightAndFits) {
  for (const double rows : {1.0, 48.0, 120.0, 240.0, 333.0, 1080.0}) {
    double weight = 0;
    for (const BloomBlur& blur : plan_bloom(rows)) {
      double sum = -blur.taps.front();
      for (const double tap : blur.taps) sum += 2 * tap;
      EXPECT_NEAR(sum, 1, 1e-12) << rows;
      weight += blur.weight;
      EXPECT_LE(blur.taps.size(), 16u) << rows;
      EXPECT_LE(blur.level, 8) << rows;
    }
    EXPECT_NEAR(weight, 1, 1e-12) << rows;
  }
}

TEST(GlarePlan, DispersionLengthensRedAndShortensBlue) {
  GlareSettings settings;
  settings.streak_dispersion = 1;
  const glm::dvec3 l = -streak_log_per_height(settings);
  EXPECT_NEAR(l.g / l.r, 610.0 / 550, 1e-12);
  EXPECT_NEAR(l.g / l.b, 465.0 / 550, 1e-12);
  settings.streak_dispersion = 0;
  EXPECT_EQ(streak_log_per_height(settings).r, streak_log_per_height(settings).b);
}

TEST(GlarePlan, FainterLightReachesLessFar) {
  const GlareSettings settings;
  const GlareReach dim = glare_reach(settings, 240, 1), bright = glare_reach(settings, 240, 1e5),
                   none = glare_reach(settings, 240, 0);
  EXPECT_LT(dim.bloom_texels, bright.bloom_texels);
  EXPECT_LT(dim.streak_texels, bright.streak_texels);
  EXPECT_EQ(none.bloom_texels, 0);
  EXPECT_EQ(none.streak_texels, 0);
}

TEST(GlarePlan, StreaksAreDrawnAsCoarselyAsTheirWidthAndFallAllow) {
  GlareSettings settings;
  EXPECT_EQ(streak_grid(settings, 240).level, 1);
  EXPECT_NEAR(streak_grid(settings, 240).own_blur, 0, 0.01) << "the pyramid's own blur is the Gaussian across";
  EXPECT_EQ(streak_grid(settings, 120).level, 0) << "too narrow";
  settings.streak_attenuation = 0.6;
  EXPECT_EQ(streak_grid(settings, 240).level, 0) << "too short";
  EXPECT_NEAR(streak_grid(settings, 240).own_blur, 1.44 * 1.44, 1e-9);
}

TEST(GlarePlan, PassesReachAsFarAsTheLightUnlessSetByHand) {
  GlareSettings settings;
  EXPECT_EQ(streak_pass_count(settings, 0), 1);
  EXPECT_EQ(streak_pass_count(settings, 64), 3);
  EXPECT_EQ(streak_pass_count(settings, 65), 4);
  EXPECT_EQ(streak_pass_count(settings, 1e9), kMaxStreakPasses);
  settings.streak_passes = 2;
  EXPECT_EQ(streak_pass_count(settings, 1e9), 2);
}

TEST(GlareTiles, RectanglesHoldEveryTileThatGrowsOutOfOneOnce) {
  TileMask mask{9, 7, std::vector<std::uint8_t>(63)};
  for (const int at : {0, 31, 33, 62}) mask.marked[static_cast<std::size_t>(at)] = 1;
  for (const auto& [across, down] : {std::pair(0, 0), std::pair(1, 0), std::pair(2, 1), std::pair(0, 3), std::pair(20, 20)}) {
    std::vector<int> held(63);
    for (const PixelRect& r : mask.grown(across, down).rectangles()) {
      for (int y = r.y; y < r.y + r.height; ++y)
        for (int x = r.x; x < r.x + r.width; ++x) ++held.at(static_cast<std::size_t>(9 * y + x));
    }
    for (int i = 0; i < 63; ++i) {
      int wanted = 0;
      for (const int at : {0, 31, 33, 62})
        if (std::abs(at % 9 - i % 9) <= across && std::abs(at / 9 - i / 9) <= down) wanted = 1;
      EXPECT_EQ(held[static_cast<std::size_t>(i)], wanted) << "tile " << i << " grown by " << across << ", " << down;
    }
  }
}

TEST(GlareKernel, SumsToTheStrengthsAtAnyResolution) {
  GlareSettings settings;
  settings.bloom_strength = 0.3;
  settings.streak_strength = 0.2;
  for (const double rows : {240.0, 480.0}) {
    const int size = static_cast<int>(2.5 * rows) | 1;
    const Image kernel = glare_kernel(settings, rows, size, size);
    double sum = 0;
    for (std::size_t i = 1; i < kernel.data.size(); i += 3) sum += kernel.data[i];
    EXPECT_NEAR(sum, 0.5, 0.002) << rows;
  }
}

TEST(GlareKernel, IsFiniteForEveryAttenuation) {
  for (const double a : {0.0, 0.5, 0.92, 0.999}) {
    GlareSettings settings;
    settings.streak_attenuation = a;
    for (const float value : glare_kernel(settings, 1080, 301, 201).data) ASSERT_TRUE(std::isfinite(value)) << a;
  }
}

}  // namespace
}  // namespace catchlight::render::test
