// Apertures: what the program draws, and what it accepts of the user's.
#include "render/glare/aperture_picture.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "render/glare/aperture_shapes.hpp"
#include "render/image/image_io.hpp"
#include "tests/support/test_files.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace catchlight::render {
namespace {

double mean(const Image& image) {
  double sum = 0;
  for (const float value : image.data) sum += value;
  return sum / static_cast<double>(image.data.size());
}

/// The message of the Error that opening `name` gives.
std::string refusal(const std::string& name) {
  try {
    aperture_picture(name);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

void write_grey(const std::string& path, int width, int height, int type, double value) {
  ASSERT_TRUE(cv::imwrite(path, cv::Mat(height, width, type, cv::Scalar::all(value))));
}

TEST(AperturePicture, LetsThroughTheAreaOfItsShape) {
  // 1e-4 is a hundredth of the pixels along the rim.
  EXPECT_NEAR(mean(circle_aperture(300)), glm::pi<double>() * 0.49 * 0.49, 1e-4);
  const double hexagon = 1.5 * std::sqrt(3.0) * 0.49 * 0.49;
  EXPECT_NEAR(mean(diaphragm_aperture({.blades = 6, .curvature = 0}, 300)), hexagon, 1e-4);
  EXPECT_NEAR(mean(diaphragm_aperture({.blades = 6, .curvature = 1}, 300)), glm::pi<double>() * 0.49 * 0.49, 1e-4)
      << "round blades";
}

TEST(AperturePicture, IsTheSameAtEverySize) {
  for (const char* name : {"circle", "blades:5", "blades:8", "eyelashes", "dust"}) {
    const AperturePicture picture = aperture_picture(name);
    const Image small = picture.draw(96), large = picture.draw(384);
    EXPECT_NEAR(mean(small), mean(large), 2e-3) << name;
    double difference = 0;
    for (int y = 0; y < 96; ++y)
      for (int x = 0; x < 96; ++x) {
        double block = 0;
        for (int v = 0; v < 4; ++v)
          for (int u = 0; u < 4; ++u) block += *large.pixel(4 * x + u, 4 * y + v) / 16;
        difference += std::abs(block - *small.pixel(x, y)) / (96 * 96);
      }
    EXPECT_LT(difference, 0.01) << name << ": a pixel is the mean over its area";
    for (const float value : large.data) ASSERT_TRUE(value >= 0 && value <= 1);
    EXPECT_EQ(picture.draw(96).data, small.data);
  }
}

TEST(AperturePicture, ReadsPngOf8And16BitsAndExr) {
  const TempFolder folder;
  write_grey(folder / "8.png", 32, 32, CV_8UC1, 51);
  write_grey(folder / "16.png", 32, 32, CV_16UC3, 13107);
  Image rgb(32, 32);
  std::fill(rgb.data.begin(), rgb.data.end(), 0.2f);
  write_exr(folder / "half.exr", {{"", &rgb, {"R", "G", "B"}}});
  for (const char* name : {"8.png", "16.png", "half.exr"}) {
    const AperturePicture picture = aperture_picture(folder / name);
    EXPECT_EQ(picture.most_px, 32);
    EXPECT_NEAR(mean(picture.draw(32)), 0.2, 1e-4) << name;
    EXPECT_NEAR(mean(picture.draw(11)), 0.2, 1e-4) << name;
  }
}

TEST(AperturePicture, SaysWhatIsWrongWithAFile) {
  const TempFolder folder;
  EXPECT_NE(refusal(folder / "none.png").find("no such file"), std::string::npos);
  write_grey(folder / "wide.png", 40, 30, CV_8UC1, 255);
  EXPECT_NE(refusal(folder / "wide.png").find("40 x 30 pixels are not square"), std::string::npos);
  write_grey(folder / "black.png", 16, 16, CV_8UC1, 0);
  EXPECT_NE(refusal(folder / "black.png").find("black all over"), std::string::npos);
  write_text(folder / "text.png", "not a picture");
  EXPECT_NE(refusal(folder / "text.png").find("text.png: is neither PNG nor JPEG nor TIFF"), std::string::npos);
  Image nan(8, 8);
  nan.data[7] = std::numeric_limits<float>::quiet_NaN();
  write_exr(folder / "nan.exr", {{"", &nan, {"R", "G", "B"}}});
  EXPECT_NE(refusal(folder / "nan.exr").find("NaN"), std::string::npos);
  for (const char* name : {"none.png", "wide.png", "black.png", "text.png", "nan.exr"})
    EXPECT_NE(refusal(folder / name).find(folder / name), std::string::npos) << "names the file";
}

TEST(AperturePicture, SaysWhatIsWrongWithBlades) {
  for (const char* name : {"blades:", "blades:2", "blades:25", "blades:six", "blades:6.5", "blades:-6", "blades:6 "})
    EXPECT_NE(refusal(name).find("N from 3 to 24"), std::string::npos) << name;
}

}  // namespace
}  // namespace catchlight::render
