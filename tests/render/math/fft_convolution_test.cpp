// Convolution by FFT against the sum that it stands for, and what must hold of any convolution.
#include "render/math/fft_convolution.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace catchlight::render {
namespace {

Image noise(int width, int height, unsigned seed) {
  Image image(width, height);
  std::mt19937 random(seed);
  for (float& value : image.data) value = static_cast<float>(random() % 10000) / 10000.0f - 0.2f;
  return image;
}

Image delta(int width, int height, int x, int y, float value = 1) {
  Image image(width, height);
  for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = value;
  return image;
}

/// The definition, in double.
Image by_sum(const Image& image, const Image& kernel) {
  Image result(image.width, image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) {
        double sum = 0;
        for (int v = 0; v < kernel.height; ++v)
          for (int u = 0; u < kernel.width; ++u) {
            const int from_x = x - (u - kernel.width / 2), from_y = y - (v - kernel.height / 2);
            if (from_x >= 0 && from_x < image.width && from_y >= 0 && from_y < image.height)
              sum += static_cast<double>(kernel.pixel(u, v)[c]) * image.pixel(from_x, from_y)[c];
          }
        result.pixel(x, y)[c] = static_cast<float>(sum);
      }
  return result;
}

double largest_difference(const Image& a, const Image& b) {
  EXPECT_EQ(a.data.size(), b.data.size());
  double largest = 0;
  for (std::size_t i = 0; i < a.data.size(); ++i) largest = std::max(largest, std::abs(double{a.data[i]} - b.data[i]));
  return largest;
}

double sum(const Image& image, int channel) {
  double total = 0;
  for (std::size_t i = static_cast<std::size_t>(channel); i < image.data.size(); i += 3) total += image.data[i];
  return total;
}

TEST(FftConvolution, IsTheSumThatItStandsForAtEverySize) {
  const int sizes[][4] = {{1, 1, 1, 1},   {1, 1, 5, 5},   {1, 9, 3, 1},    {2, 3, 2, 2},     {7, 5, 4, 3},  {8, 8, 8, 8},
                          {13, 17, 6, 9}, {16, 12, 7, 5}, {31, 30, 33, 2}, {11, 10, 64, 51}, {20, 1, 1, 40}};
  for (const auto& [width, height, kernel_width, kernel_height] : sizes) {
    const Image image = noise(width, height, 1), kernel = noise(kernel_width, kernel_height, 2);
    const Image result = FftConvolution(kernel, width, height).convolve(image);
    EXPECT_LT(largest_difference(result, by_sum(image, kernel)), 5e-5)
        << width << " x " << height << " by " << kernel_width << " x " << kernel_height;
  }
}

TEST(FftConvolution, ADeltaShiftsByItsPlaceInTheKernelAndNothingWrapsRound) {
  const Image image = noise(15, 12, 3);
  for (const int size : {9, 10}) {  // the centre is pixel size / 2 of both
    const FftConvolution convolution(delta(size, size, size / 2 + 2, size / 2 - 3), 15, 12);
    const Image result = convolution.convolve(image);
    for (int y = 0; y < 12; ++y)
      for (int x = 0; x < 15; ++x) {
        const float expected = x >= 2 && y + 3 < 12 ? image.pixel(x - 2, y + 3)[1] : 0.0f;
        ASSERT_NEAR(result.pixel(x, y)[1], expected, 1e-6) << x << ' ' << y;
      }
  }
}

TEST(FftConvolution, KeepsTheChannelsApart) {
  Image image = delta(9, 9, 4, 4), kernel(3, 3);
  kernel.pixel(0, 1)[0] = 1;
  kernel.pixel(1, 1)[1] = 2;
  kernel.pixel(1, 2)[2] = 3;
  const Image result = FftConvolution(kernel, 9, 9).convolve(image);
  Image expected(9, 9);
  expected.pixel(3, 4)[0] = 1;
  expected.pixel(4, 4)[1] = 2;
  expected.pixel(4, 5)[2] = 3;
  EXPECT_LT(largest_difference(result, expected), 1e-6);
}

TEST(FftConvolution, KeepsTheEnergyOfWhatStaysInsideTheImage) {
  const Image kernel = noise(11, 11, 4);
  Image image(40, 40);
  for (int y = 6; y < 34; ++y)
    for (int x = 6; x < 34; ++x)
      for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = static_cast<float>((x * 7 + y * 3 + c) % 11);
  const Image result = FftConvolution(kernel, 40, 40).convolve(image);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum(result, c) / (sum(image, c) * sum(kernel, c)), 1.0, 1e-5);
}

TEST(FftConvolution, IsLinear) {
  const FftConvolution convolution(noise(9, 6, 5), 21, 14);
  const Image a = noise(21, 14, 6), b = noise(21, 14, 7);
  Image both = a;
  for (std::size_t i = 0; i < both.data.size(); ++i) both.data[i] = 3 * a.data[i] - 2 * b.data[i];
  Image expected = convolution.convolve(a);
  const Image of_b = convolution.convolve(b);
  for (std::size_t i = 0; i < both.data.size(); ++i) expected.data[i] = 3 * expected.data[i] - 2 * of_b.data[i];
  EXPECT_LT(largest_difference(convolution.convolve(both), expected), 1e-4);
}

TEST(FftConvolution, ASunPixelSpreadsExactlyTheKernel) {
  // The rounding of one bright pixel must not be seen in the dark part of the frame.
  const Image kernel = noise(31, 31, 8);
  const Image result = FftConvolution(kernel, 64, 48).convolve(delta(64, 48, 32, 24, 6e4f));
  for (int v = 0; v < 31; ++v)
    for (int u = 0; u < 31; ++u)
      ASSERT_NEAR(result.pixel(32 + u - 15, 24 + v - 15)[2] / 6e4, kernel.pixel(u, v)[2], 1e-5) << u << ' ' << v;
  EXPECT_NEAR(result.pixel(0, 0)[0] / 6e4, 0, 1e-6);
}

TEST(FftConvolution, GivesTheSameBitsAgain) {
  const Image kernel = noise(30, 30, 9), image = noise(50, 33, 10);
  const FftConvolution convolution(kernel, 50, 33);
  const Image first = convolution.convolve(image);
  EXPECT_EQ(first.data, convolution.convolve(image).data);
  EXPECT_EQ(first.data, FftConvolution(kernel, 50, 33).convolve(image).data);
}

TEST(FftConvolution, PadsNoMoreThanItMust) {
  // A kernel larger than the image reaches from edge to edge and no further: 2 * size - 1, up to the next fast size.
  const FftConvolution convolution(delta(5000, 5000, 2500, 2500), 320, 240);
  EXPECT_EQ(convolution.transform_width(), 640);
  EXPECT_EQ(convolution.transform_height(), 480);
}

TEST(FftConvolution, NanAndInfinityInTheImageCountAsBlack) {
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                       -std::numeric_limits<float>::infinity()};
  const Image kernel = noise(5, 5, 11), clean = noise(16, 16, 12);
  const FftConvolution convolution(kernel, 16, 16);
  for (const float value : bad) {
    Image image = clean, black = clean;
    image.pixel(3, 4)[0] = value;
    black.pixel(3, 4)[0] = 0;
    EXPECT_EQ(convolution.convolve(image).data, convolution.convolve(black).data) << value;
  }
  const Image huge = convolution.convolve(delta(16, 16, 8, 8, std::numeric_limits<float>::max()));
  for (const float value : huge.data) ASSERT_TRUE(std::isfinite(value));
}

TEST(FftConvolution, ABlackFrameStaysBlack) {
  const Image result = FftConvolution(noise(7, 7, 13), 12, 10).convolve(Image(12, 10));
  for (const float value : result.data) ASSERT_EQ(value, 0.0f);
}

TEST(FftConvolution, RefusesWhatCannotBeConvolved) {
  Image nan = delta(3, 3, 1, 1);
  nan.data[5] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(FftConvolution(nan, 8, 8), Error);
  EXPECT_THROW(FftConvolution(Image(), 8, 8), Error);
  EXPECT_THROW(FftConvolution(Image(3, 3, 1), 8, 8), Error);
  EXPECT_THROW(FftConvolution(delta(3, 3, 1, 1), 0, 8), Error);
  EXPECT_THROW(FftConvolution(delta(3, 3, 1, 1), 8, 8).convolve(Image(8, 9)), Error);
  EXPECT_THROW(FftConvolution(delta(3, 3, 1, 1), 8, 8).convolve(Image(8, 8, 4)), Error);
}

}  // namespace
}  // namespace catchlight::render
