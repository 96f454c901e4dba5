#include "render/cpu/plate/layer_blur.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace catchlight::render {
namespace {

constexpr int kWidth = 60, kHeight = 44;

/// Random pixels within `active`, on a constant.
Image picture(const PixelRect& active, float around = 0) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> value(0, 3);
  Image image(kWidth, kHeight, 4);
  std::ranges::fill(image.data, around);
  for (int y = active.y; y < active.y + active.height; ++y)
    for (int x = active.x; x < active.x + active.width; ++x)
      for (int c = 0; c < 4; ++c) image.pixel(x, y)[c] = value(random);
  return image;
}

double sum_of(const Image& image, int channel) {
  double sum = 0;
  for (std::size_t i = static_cast<std::size_t>(channel); i < image.data.size(); i += 4) sum += image.data[i];
  return sum;
}

/// Every pixel times every weight; at the borders the outermost pixels go on.
Image directly_blurred(const Image& image, double variance_px2) {
  const std::vector<float> weights = discrete_gaussian(variance_px2);
  const int reach = static_cast<int>(weights.size()) - 1;
  Image result = image;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 4; ++c) {
        double sum = 0;
        for (int v = -reach; v <= reach; ++v)
          for (int u = -reach; u <= reach; ++u)
            sum += double{weights[static_cast<std::size_t>(std::abs(u))]} * weights[static_cast<std::size_t>(std::abs(v))] *
                   image.pixel(std::clamp(x + u, 0, image.width - 1), std::clamp(y + v, 0, image.height - 1))[c];
        result.pixel(x, y)[c] = static_cast<float>(sum);
      }
  return result;
}

double largest_difference(const Image& a, const Image& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.data.size(); ++i) most = std::max(most, std::abs(double{a.data[i]} - b.data[i]));
  return most;
}

TEST(LayerBlur, DefocusIsTheSumOverAllPixels) {
  LayerBlur blur;
  for (const PixelRect& active : {PixelRect{20, 15, 11, 9}, {0, 0, 7, 44}, {52, 36, 8, 8}, {0, 0, kWidth, kHeight}})
    for (const double variance : {0.1, 1.0, 9.0}) {
      for (const float around : {0.0f, 1.0f}) {
        Image image = picture(active, around);
        const Image expected = directly_blurred(image, variance);
        blur.defocus(image, {&active, 1}, discrete_gaussian(variance));
        EXPECT_LT(largest_difference(image, expected), 1e-4) << variance << " " << active.x;
      }
    }
}

TEST(LayerBlur, DefocusIsThatSumInBandsToo) {
  LayerBlur blur;
  const std::vector<PixelRect> bands{{10, 4, 30, 8}, {25, 12, 9, 8}, {3, 28, 50, 8}};
  Image image = picture(bands[0]);
  for (const PixelRect& band : {bands[1], bands[2]}) {
    const Image more = picture(band);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = std::max(image.data[i], more.data[i]);
  }
  const Image expected = directly_blurred(image, 4);
  blur.defocus(image, bands, discrete_gaussian(4));
  EXPECT_LT(largest_difference(image, expected), 1e-4);
}

TEST(LayerBlur, KeepsTheLight) {
  LayerBlur blur;
  const PixelRect active{25, 18, 8, 6};
  Image image = picture(active);
  const double before = sum_of(image, 1);
  blur.defocus(image, {&active, 1}, discrete_gaussian(2));
  EXPECT_NEAR(sum_of(image, 1) / before, 1, 1e-4);
  for (const glm::dvec2& way : {glm::dvec2(6, 0), {0, 9.5}, {5, 5}, {-3, 8}, {0.7, 0.2}}) {
    Image moved = picture(active);
    blur.move(moved, active, {.displacement_px = way}, {0, 0});
    EXPECT_NEAR(sum_of(moved, 1) / before, 1, 1e-4) << way.x << ", " << way.y;
  }
}

TEST(LayerBlur, MotionHasTheBoxesVarianceAlongItsWay) {
  LayerBlur blur;
  for (const glm::dvec2& way : {glm::dvec2(6, 0), {0, 9.5}, {0, -3}, {8, 4}}) {
    Image image(kWidth, kHeight, 4);
    image.pixel(30, 20)[0] = 1;
    blur.move(image, {30, 20, 1, 1}, {.displacement_px = way}, {0, 0});
    const glm::dvec2 along = glm::normalize(way);
    double second = 0, first = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const double at = glm::dot(along, glm::dvec2(x - 30, y - 20));
        first += image.pixel(x, y)[0] * at, second += image.pixel(x, y)[0] * at * at;
      }
    EXPECT_NEAR(first, 0, 0.3) << "steps of whole pixels lie on one side where the way is aslant";
    EXPECT_NEAR(second, glm::dot(way, way) / 12, 0.05 * glm::dot(way, way) / 12 + 0.02) << way.x << ", " << way.y;
  }
}

TEST(LayerBlur, MotionIsOfTheFramesPixels) {
  // A turn around the frame's (100, 50): an image whose first pixel is there does not move in its corner.
  LayerBlur blur;
  const MotionField turn{.origin_px = {100, 50}, .change = glm::dmat2(0, 0.3, -0.3, 0)};
  Image image = picture({0, 0, kWidth, kHeight});
  const Image before = image;
  blur.move(image, {0, 0, kWidth, kHeight}, turn, {100, 50});
  for (int c = 0; c < 4; ++c) EXPECT_EQ(image.pixel(0, 0)[c], before.pixel(0, 0)[c]);
  EXPECT_NE(image.pixel(30, 30)[0], before.pixel(30, 30)[0]);
}

TEST(LayerBlur, LeavesAloneWhatItDoesNotReach) {
  LayerBlur blur;
  for (const bool moves : {false, true}) {
    Image image = picture({20, 15, 4, 4}, 1);
    const PixelRect active{20, 15, 4, 4};
    if (moves)
      blur.move(image, active, {.displacement_px = {5, 0}}, {0, 0});
    else
      blur.defocus(image, {&active, 1}, discrete_gaussian(1));
    EXPECT_EQ(image.pixel(59, 43)[0], 1);
    EXPECT_EQ(image.pixel(0, 15)[3], 1);
    EXPECT_NEAR(image.pixel(22, 25)[0], 1, 1e-5) << "a constant stays one";
  }
  Image empty = picture({});
  blur.defocus(empty, {}, discrete_gaussian(3));
  blur.move(empty, {}, {.displacement_px = {5, 0}}, {0, 0});
  EXPECT_EQ(sum_of(empty, 0), 0);
}

}  // namespace
}  // namespace catchlight::render
