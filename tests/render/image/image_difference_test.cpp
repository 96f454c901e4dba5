// The comparator must see what an eye would, and each figure what the others miss.
#include "render/image/image_difference.hpp"
#include "catchlight/error.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace catchlight::render {
namespace {

/// A disc with a gradient on a striped ground.
cv::Mat picture() {
  cv::Mat image(60, 80, CV_32FC3);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const bool in_disc = std::hypot(x - 40, y - 28) < 18;
      const float stripe = (x / 5 + y / 7) % 2 ? 0.4f : 0.3f;
      image.at<cv::Vec3f>(y, x) =
          in_disc ? cv::Vec3f(0.2f, 0.5f, 0.3f + 0.01f * static_cast<float>(y)) : cv::Vec3f(stripe, stripe, stripe);
    }
  }
  return image;
}

TEST(ImageDifference, EqualPicturesDoNotDiffer) {
  const ImageDifference d = image_difference(picture(), picture());
  EXPECT_EQ(d.max_abs, 0);
  EXPECT_EQ(d.mean_abs, 0);
  EXPECT_EQ(d.p99, 0);
  EXPECT_TRUE(std::isinf(d.psnr_db));
  EXPECT_NEAR(d.ssim, 1.0, 1e-6);  // 32-bit map
}

TEST(ImageDifference, AUniformOffsetHasClosedForms) {
  const cv::Mat a(30, 30, CV_32FC3, cv::Scalar::all(0.4)), b(30, 30, CV_32FC3, cv::Scalar::all(0.5));
  const ImageDifference d = image_difference(a, b);
  EXPECT_NEAR(d.max_abs, 0.1, 1e-6);
  EXPECT_NEAR(d.mean_abs, 0.1, 1e-6);
  EXPECT_NEAR(d.psnr_db, 20.0, 1e-4);
  EXPECT_NEAR(d.ssim, (2 * 0.2 + 1e-4) / (0.16 + 0.25 + 1e-4), 1e-6);  // flat: only the means' term is left
}

TEST(ImageDifference, EightBitCodesAreFractionsOfWhite) {
  const cv::Mat a(4, 4, CV_8UC1, cv::Scalar(100)), b(4, 4, CV_8UC1, cv::Scalar(151));
  EXPECT_NEAR(image_difference(a, b).max_abs, 0.2, 1e-6);
}

TEST(ImageDifference, StructureIsSymmetricAndFallsWithNoise) {
  cv::Mat noise(60, 80, CV_32FC3);
  cv::theRNG().state = 7;
  cv::randn(noise, 0.0, 0.02);
  const cv::Mat a = picture(), little = a + noise, much = a + 4 * noise;
  EXPECT_NEAR(image_difference(a, little).ssim, image_difference(little, a).ssim, 1e-9);
  EXPECT_LT(image_difference(a, much).ssim, image_difference(a, little).ssim - 0.1);
}

TEST(ImageDifference, NotANumberEqualsItselfAndNothingElse) {
  cv::Mat a = picture(), b = picture();
  a.at<cv::Vec3f>(5, 5)[0] = b.at<cv::Vec3f>(5, 5)[0] = std::numeric_limits<float>::quiet_NaN();
  a.at<cv::Vec3f>(6, 5)[0] = b.at<cv::Vec3f>(6, 5)[0] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(image_difference(a, b).max_abs, 0);
  EXPECT_NEAR(image_difference(a, b).ssim, 1.0, 1e-6);
  b.at<cv::Vec3f>(5, 5)[0] = 0.5f;
  EXPECT_TRUE(std::isinf(image_difference(a, b).max_abs));
  EXPECT_LT(image_difference(a, b).ssim, 0.9999);
}

TEST(ImageDifference, PicturesOfOtherShapeAreRefused) {
  EXPECT_THAT([] { image_difference(cv::Mat(2, 3, CV_8UC3), cv::Mat(3, 2, CV_8UC3)); },
              ::testing::ThrowsMessage<Error>(::testing::HasSubstr("3 x 2 CV_8UC3 with 2 x 3 CV_8UC3")));
  EXPECT_THROW(image_difference(cv::Mat(), cv::Mat()), Error);
}

}  // namespace
}  // namespace catchlight::render
