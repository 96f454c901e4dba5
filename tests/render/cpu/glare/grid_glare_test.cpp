// What glare on processors must keep, whatever the picture; grid_glare_gl_test holds it against a card's.
#include "render/cpu/glare/grid_glare.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "catchlight/image.hpp"
#include "render/settings.hpp"

namespace catchlight::render::test {
namespace {

/// A square of one pixel whose corner is at (x, y), parts of it in up to four pixels, on black; premultiplied RGBA.
Image highlight(int width, int height, double x, double y, float light) {
  Image picture(width, height, 4);
  const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
  for (const int u : {0, 1})
    for (const int v : {0, 1}) {
      const double share = (u == 0 ? left + 1 - x : x - left) * (v == 0 ? top + 1 - y : y - top);
      if (share > 0) std::fill_n(picture.pixel(left + u, top + v), 3, static_cast<float>(light * share));
    }
  return picture;
}

Image filled(int width, int height, float value) {
  Image picture(width, height, 4);
  std::fill(picture.data.begin(), picture.data.end(), value);
  return picture;
}

PixelRect all_of(const Image& picture) {
  return {0, 0, picture.width, picture.height};
}

struct Glared {
  bool any;
  PixelRect reach;
  Image frame;  ///< of all pixels; empty where there is none
};

Glared glared(GridGlare& glare, const Image& picture) {
  Glared result{glare.extract(picture, nullptr, all_of(picture), picture.width, picture.height), {}, {}};
  if (!result.any) return result;
  result.reach = glare.spread({});
  result.frame = Image(picture.width, picture.height, 3);
  for (int y = 0; y < picture.height; ++y) glare.read_row(0, y, picture.width, result.frame.pixel(0, y));
  return result;
}

Glared glared(const GlareSettings& settings, const Image& picture) {
  GridGlare glare(settings);
  return glared(glare, picture);
}

double sum_of(const Image& image) {
  double sum = 0;
  for (const float value : image.data) sum += value;
  return sum;
}

TEST(GridGlare, IsNoneWhereNothingIsBright) {
  EXPECT_FALSE(glared(GlareSettings{}, filled(160, 120, 0)).any);
  EXPECT_FALSE(glared(GlareSettings{}, filled(160, 120, 1)).any);
  EXPECT_TRUE(glared(GlareSettings{}, filled(160, 120, 1.1f)).any);
  EXPECT_FALSE(GridGlare(GlareSettings{}).extract(Image(0, 0, 4), nullptr, {}, 160, 120)) << "no object";
}

TEST(GridGlare, CoverageIsNoLight) {
  GlareSettings settings;
  settings.threshold = 0.5;
  Image picture = filled(160, 120, 0.4f);
  for (std::size_t i = 3; i < picture.data.size(); i += 4) picture.data[i] = 1;
  EXPECT_FALSE(glared(settings, picture).any);
}

TEST(GridGlare, AHighlightKeepsItsEnergyWhereverItLiesOnTheGrid) {
  GlareSettings settings;
  settings.streak_attenuation = 0.85;  // so short that none leaves the frame
  GridGlare glare(settings);
  for (const float light : {1000.0f, 1e5f}) {
    double least = std::numeric_limits<double>::max(), most = 0;
    for (int i = 0; i < 36; ++i) {
      const Glared result = glared(glare, highlight(1280, 720, 600 + 0.5 * (i % 6), 300 + 0.5 * (i / 6), light));
      ASSERT_TRUE(result.any);
      const double energy = sum_of(result.frame);
      least = std::min(least, energy), most = std::max(most, energy);
      // The excess is in texels of 3 x 3 pixels.
      const double excess = 9 * sum_of(glare.read_excess());
      EXPECT_NEAR(energy / excess / (settings.bloom_strength + settings.streak_strength), 1, 0.01) << light << ", " << i;
    }
    EXPECT_LT(most / least - 1, 0.01) << light;
  }
}

Image mirrored(const Image& image) {
  Image result = image;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) std::copy_n(image.pixel(x, y), image.channels, result.pixel(image.width - 1 - x, y));
  return result;
}

Image turned_over(const Image& image) {
  Image result = image;
  for (int y = 0; y < image.height; ++y)
    std::copy_n(image.pixel(0, y), image.width * image.channels, result.pixel(0, image.height - 1 - y));
  return result;
}

void expect_near(const Image& a, const Image& b, const char* what) {
  ASSERT_EQ(a.data.size(), b.data.size());
  const double peak = *std::max_element(b.data.begin(), b.data.end());
  for (std::size_t i = 0; i < a.data.size(); ++i) ASSERT_NEAR(a.data[i], b.data[i], 1e-6 * peak) << what << ", at " << i;
}

TEST(GridGlare, OfAMirroredPictureIsMirrored) {
  // Halved again and again this grid keeps its symmetry.
  GlareSettings settings;
  settings.grid_rows = 256;
  const Image picture = highlight(1024, 512, 317, 101, 2000);
  const Image glare = glared(settings, picture).frame;
  expect_near(glared(settings, mirrored(picture)).frame, mirrored(glare), "left and right");
  expect_near(glared(settings, turned_over(picture)).frame, turned_over(glare), "up and down");
}

TEST(GridGlare, ReachesAllThatCanBeSeen) {
  const Glared result = glared(GlareSettings{}, highlight(1280, 720, 1000, 90, 60));
  EXPECT_LT(result.reach.width, 1280);
  EXPECT_LT(result.reach.height, 720);
  for (int y = 0; y < 720; ++y)
    for (int x = 0; x < 1280; ++x)
      if (intersect({x, y, 1, 1}, result.reach).empty()) {
        ASSERT_LT(result.frame.pixel(x, y)[0], 1e-4f) << x << ", " << y;
      }
}

TEST(GridGlare, IsReadInAnyPieces) {
  GridGlare glare(GlareSettings{});
  const Image whole = glared(glare, highlight(641, 481, 200, 240, 1000)).frame;
  std::vector<float> piece(3 * 641);
  for (const int count : {1, 59, 60, 61, 200})
    for (int x = 0; x + count <= 641; x += 97) {
      glare.read_row(x, 250, count, piece.data());
      for (int i = 0; i < 3 * count; ++i)
        ASSERT_EQ(piece[static_cast<std::size_t>(i)], whole.pixel(x, 250)[i]) << x << ", " << count;
    }
}

TEST(GridGlare, DoesNotRememberTheFrameBefore) {
  GridGlare kept(GlareSettings{});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  for (int frame = 0; frame < 12; ++frame) {
    const int width = frame % 5 == 4 ? 320 : 641, height = frame % 5 == 4 ? 240 : 479;
    Image picture(width, height, 4);
    for (int i = 0; i < 3; ++i) {
      const Image one = highlight(width, height, share(random) * (width - 2), share(random) * (height - 2),
                                  static_cast<float>(std::exp2(2 + 10 * share(random))));
      for (std::size_t k = 0; k < one.data.size(); ++k) picture.data[k] += one.data[k];
    }
    const Glared again = glared(kept, picture), fresh = glared(GlareSettings{}, picture);
    ASSERT_EQ(again.any, fresh.any);
    EXPECT_EQ(again.reach, fresh.reach) << frame;
    EXPECT_EQ(again.frame.data, fresh.frame.data) << frame;
  }
}

TEST(GridGlare, OfTheWholeFrameIsThatOfTheObjectsRectangle) {
  const Image picture = highlight(640, 480, 300, 200, 1000);
  const PixelRect rect{290, 195, 40, 30};
  Image object(rect.width, rect.height, 4);
  for (int y = 0; y < rect.height; ++y) std::copy_n(picture.pixel(rect.x, rect.y + y), 4 * rect.width, object.pixel(0, y));
  const Image whole = glared(GlareSettings{}, picture).frame;
  GridGlare glare(GlareSettings{});
  ASSERT_TRUE(glare.extract(object, nullptr, rect, 640, 480));
  glare.spread({});
  Image frame(640, 480, 3);
  for (int y = 0; y < 480; ++y) glare.read_row(0, y, 640, frame.pixel(0, y));
  EXPECT_EQ(frame.data, whole.data);
}

TEST(GridGlare, LightSourcesOfStrengthNothingDoNotGlare) {
  GlareSettings settings;
  settings.emitter_strength = 0;
  const Image lamp = highlight(640, 480, 320, 240, 1000), nothing(640, 480, 3);
  GridGlare glare(settings);
  EXPECT_FALSE(glare.extract(lamp, &lamp, all_of(lamp), 640, 480));
  EXPECT_TRUE(glare.extract(lamp, &nothing, all_of(lamp), 640, 480));
}

TEST(GridGlare, NanAndInfinityAndNegativeLightDoNotSpread) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const Image clean = highlight(160, 120, 40, 60, 1000);
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kInf, -kInf, -1e30f, 1e30f}) {
    Image picture = clean;
    std::fill_n(picture.pixel(120, 60), 3, bad);
    const Glared result = glared(GlareSettings{}, picture);
    ASSERT_TRUE(result.any);
    for (const float value : result.frame.data) ASSERT_TRUE(value >= 0 && value < 1e6f) << value;
    if (bad > 0) continue;
    EXPECT_EQ(result.frame.data, glared(GlareSettings{}, clean).frame.data) << "counts as nothing: " << bad;
  }
}

}  // namespace
}  // namespace catchlight::render::test
