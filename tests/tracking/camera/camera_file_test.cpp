// Camera files as OpenCV and ROS write them, and every way they can be wrong.
#include "tracking/camera/camera_file.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace catchlight::tracking {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kOpenCv = R"(%YAML:1.0
---
image_width: 640
image_height: 480
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 600.5, 0., 3.195e+02, 0., 601.25, 239.5, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ -0.3, 0.12, 0.001, -0.002, 0.05 ]
)";

constexpr const char* kRos = R"(image_width: 1280
image_height: 720
camera_name: head_camera
camera_matrix:
  rows: 3
  cols: 3
  data: [900, 0, 640.5,
         0, 901, 360.5,
         0, 0, 1]
distortion_model: rational_polynomial
distortion_coefficients:
  rows: 1
  cols: 8
  data: [1, 2, 3, 4, 5, 6, 7, 8]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
)";

class CameraFile : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  CameraModel read(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return read_camera_file(path_);
  }

  std::string message(const std::string& text) {
    try {
      read(text);
    } catch (const Error& error) {
      return error.what();
    }
    return "(no error)";
  }

  static std::string with(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  }

  const std::string path_ =
      (std::filesystem::temp_directory_path() /
       ("catchlight_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + ".yaml"))
          .string();
};

TEST_F(CameraFile, ReadsWhatOpenCvWrites) {
  const CameraModel camera = read(kOpenCv);
  EXPECT_EQ(camera.width_px, 640);
  EXPECT_EQ(camera.height_px, 480);
  EXPECT_EQ(camera.fx_px, 600.5);
  EXPECT_EQ(camera.fy_px, 601.25);
  EXPECT_EQ(camera.cx_px, 319.5);
  EXPECT_EQ(camera.cy_px, 239.5);
  EXPECT_EQ(camera.distortion, (std::array<double, 8>{-0.3, 0.12, 0.001, -0.002, 0.05, 0, 0, 0}));
}

TEST_F(CameraFile, ReadsWhatRosWrites) {
  const CameraModel camera = read(kRos);
  EXPECT_EQ(camera.width_px, 1280);
  EXPECT_EQ(camera.fx_px, 900);
  EXPECT_EQ(camera.fy_px, 901);
  EXPECT_EQ(camera.cx_px, 640.5);
  EXPECT_EQ(camera.cy_px, 360.5);
  EXPECT_EQ(camera.distortion, (std::array<double, 8>{1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(read(std::string("---\n") + kRos).fx_px, 900) << "with a document marker";
}

TEST_F(CameraFile, ReadsFourCoefficientsAndFourteenIfTheExtraOnesAreZero) {
  const auto coefficients = [&](int count, const std::string& data) {
    return with(with(kOpenCv, "cols: 5", "cols: " + std::to_string(count)), "-0.3, 0.12, 0.001, -0.002, 0.05", data);
  };
  EXPECT_EQ(read(coefficients(4, "1, 2, 3, 4")).distortion, (std::array<double, 8>{1, 2, 3, 4}));
  EXPECT_EQ(read(coefficients(14, "1, 2, 3, 4, 5, 6, 7, 8, 0, 0, 0, 0, 0, 0")).distortion[7], 8);
  EXPECT_THAT(message(coefficients(14, "1, 2, 3, 4, 5, 6, 7, 8, 0, 0, 0.1, 0, 0, 0")), HasSubstr("thin-prism"));
  EXPECT_THAT(message(coefficients(6, "1, 2, 3, 4, 5, 6")), HasSubstr("found 6"));
}

TEST_F(CameraFile, RefusesFisheyeModels) {
  for (const std::string model : {"equidistant", "fisheye", "kannala_brandt4"})
    EXPECT_THAT(message(with(kRos, "rational_polynomial", model)),
                AllOf(HasSubstr(path_), HasSubstr("distortion_model"), HasSubstr(model), HasSubstr("plumb_bob")));
}

TEST_F(CameraFile, NamesTheFileAndTheMissingKey) {
  for (const std::string key : {"image_width", "image_height", "camera_matrix", "distortion_coefficients"})
    EXPECT_THAT(message(with(kOpenCv, key, "renamed")), AllOf(HasSubstr(path_), HasSubstr(key), HasSubstr("missing")));
}

TEST_F(CameraFile, RefusesValuesThatNoCameraHas) {
  const auto refuses = [&](const std::string& from, const std::string& to, const std::string& key) {
    EXPECT_THAT(message(with(kOpenCv, from, to)), AllOf(HasSubstr(path_), HasSubstr(key))) << from << " -> " << to;
  };
  refuses("600.5", "0", "camera_matrix");
  refuses("600.5", "-600.5", "camera_matrix");
  refuses("600.5", ".NaN", "camera_matrix");
  refuses("600.5", ".Inf", "camera_matrix");
  refuses("[ 600.5, 0.,", "[ 600.5, 3.,", "camera_matrix");
  refuses("0., 0., 1. ]", "0., 0., 2. ]", "camera_matrix");
  refuses("3.195e+02, ", "", "camera_matrix");
  refuses("[ -0.3", "[ .NaN", "distortion_coefficients");
  refuses("640", "0", "image_width");
  refuses("640", "-640", "image_width");
  refuses("640", "640.5", "image_width");
  refuses("640", "wide", "image_width");
  refuses("480", "100000000", "image_height");
}

TEST_F(CameraFile, RefusesWhatIsNoCameraFile) {
  EXPECT_THAT(message(""), AllOf(HasSubstr(path_), HasSubstr("empty")));
  for (const std::string text : {"just some words\n", "\x89PNG\r\n\x1a\n\0\0", "{ \"image_width\": ", "- 1\n- 2\n",
                                 "%YAML:1.0\n---\n", "%YAML:1.0\n---\ncamera_matrix: [", "image_width: [1, 2\nimage_height: }"})
    EXPECT_THAT(message(text), HasSubstr(path_)) << text;
  EXPECT_THROW(read_camera_file("/nonexistent/camera.yaml"), Error);
  EXPECT_THROW(read_camera_file(std::filesystem::temp_directory_path().string()), Error);
}

TEST(CameraFromFieldOfView, SeesTheImagesOuterEdgesAtTheGivenAngle) {
  const CameraModel camera = camera_from_field_of_view(640, 480, 90);
  EXPECT_DOUBLE_EQ(camera.fx_px, 320);
  EXPECT_DOUBLE_EQ(camera.fy_px, 320);
  EXPECT_DOUBLE_EQ(camera.cx_px, 319.5);
  EXPECT_DOUBLE_EQ(camera.cy_px, 239.5);
  EXPECT_FALSE(camera.has_distortion());
}

TEST_F(CameraFile, VignettingIsOptionalAndStaysAboveNothing) {
  EXPECT_EQ(read(kOpenCv).vignetting, glm::dvec3(0));
  EXPECT_EQ(read(std::string(kOpenCv) + "vignetting: [ -0.3, 0.1, -0.05 ]\n").vignetting, glm::dvec3(-0.3, 0.1, -0.05));
  const auto refusal = [&](const std::string& value) {
    try {
      read(std::string(kOpenCv) + "vignetting: " + value + "\n");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(refusal("[ -0.3, 0.1 ]"), HasSubstr("expected three numbers"));
  EXPECT_THAT(refusal("0.3"), HasSubstr("expected a list"));
  EXPECT_THAT(refusal("[ -1, 0, 0 ]"), HasSubstr("above 0 up to the corners"));
}

TEST(CameraFromFieldOfView, RefusesAnglesAndSizesThatCannotBe) {
  for (const double fov_deg : {0.0, -10.0, 180.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(camera_from_field_of_view(640, 480, fov_deg), Error) << fov_deg;
  EXPECT_THROW(camera_from_field_of_view(0, 480, 60), Error);
}

}  // namespace
}  // namespace catchlight::tracking
