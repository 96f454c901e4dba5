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

// --- as others write them -------------------------------------------------------------------------------------------------

/// The camera that all of these describe.
void expect_common_camera(const CameraModel& camera, const std::string& what, int width_px = 640, int height_px = 480) {
  EXPECT_EQ(camera.width_px, width_px) << what;
  EXPECT_EQ(camera.height_px, height_px) << what;
  EXPECT_EQ(camera.fx_px, 600) << what;
  EXPECT_EQ(camera.fy_px, 601) << what;
  EXPECT_EQ(camera.cx_px, 319.5) << what;
  EXPECT_EQ(camera.cy_px, 239.5) << what;
  EXPECT_EQ(camera.distortion, (std::array<double, 8>{-0.1, 0.02, 1e-5, 0, 0})) << what;
}

TEST_F(CameraFile, ReadsJsonOfPythonAndOfOpenCv) {
  expect_common_camera(read(R"({"image_width": 640, "image_height": 480,
    "camera_matrix": [[600.0, 0.0, 319.5], [0.0, 601.0, 239.5], [0.0, 0.0, 1.0]],
    "dist_coeffs": [[-0.1, 0.02, 1e-05, 0.0, 0.0]], "rms": 0.2})"),
                       "json.dump");
  expect_common_camera(read("{\n\t\"image_size\": [640, 480],\n\t\"mtx\": [[600, 0, 319.5], [0, 601, 239.5], [0, 0, 1]],\n"
                            "\t\"dist\": [-0.1, 0.02, 1e-5, 0]\n}"),
                       "names of OpenCV's tutorial");
  expect_common_camera(read(R"({"image_width": 640, "image_height": 480, "camera_matrix": {"type_id": "opencv-matrix",
    "rows": 3, "cols": 3, "dt": "d", "data": [ 600.0, 0.0, 3.195e+02, 0.0, 601.0, 239.5, 0.0, 0.0, 1.0 ]},
    "distortion_coefficients": {"type_id": "opencv-matrix", "rows": 1, "cols": 5, "dt": "d", "data": [-0.1, 2e-2, 1.0e-05, 0.0, 0.0]}})"),
                       "cv::FileStorage");
}

TEST_F(CameraFile, ReadsYamlOfPythonFlowBlockAndPrintedArrays) {
  const std::string size = "image_width: 640\nimage_height: 480\n";
  expect_common_camera(read(size + "camera_matrix: [[600.0, 0.0, 319.5], [0.0, 601.0, 239.5], [0.0, 0.0, 1.0]]\n"
                                   "distortion_coefficients: [[-0.1, 0.02, 1.0e-05, 0.0, 0.0]]\n"),
                       "flow");
  expect_common_camera(read(size + "camera_matrix:\n- - 600.0\n  - 0.0\n  - 319.5\n- - 0.0\n  - 601.0\n  - 239.5\n- - 0.0\n"
                                   "  - 0.0\n  - 1.0\ndist_coeff:\n- - -0.1\n  - 0.02\n  - 1.0e-05\n  - 0.0\n  - 0.0\n"),
                       "block");
  expect_common_camera(read(size + "camera_matrix: |\n  [[600.    0.  319.5]\n   [  0.  601.  239.5]\n   [  0.    0.    1. ]]\n"
                                   "dist_coeffs: \"[[-1.e-01  2.e-02  1.e-05  0.  0.]]\"\n"),
                       "print");
  expect_common_camera(read("cameraMatrix: [600, 0, 319.5, 0, 601, 239.5, 0, 0, 1]\ndistCoeffs: [-0.1, 0.02, 0.00001, 0]\n"
                            "imageSize: !!python/tuple [640, 480]\n"),
                       "tuple");
}

TEST_F(CameraFile, ReadsXmlOfOpenCvBlockListsOfRosAndKalibr) {
  expect_common_camera(read(R"(<?xml version="1.0"?>
<opencv_storage><image_width>640</image_width><image_height>480</image_height>
<camera_matrix type_id="opencv-matrix"><rows>3</rows><cols>3</cols><dt>d</dt>
  <data>600. 0. 3.195e+02 0. 601. 239.5 0. 0. 1.</data></camera_matrix>
<distortion_coefficients type_id="opencv-matrix"><rows>1</rows><cols>5</cols><dt>d</dt>
  <data>-0.1 0.02 1e-05 0. 0.</data></distortion_coefficients></opencv_storage>)"),
                       "XML");
  expect_common_camera(read("header:\n  frame_id: camera\nheight: 480\nwidth: 640\ndistortion_model: plumb_bob  # five\n"
                            "d:\n- -0.1\n- 0.02\n- 1.0e-05\n- 0.0\n- 0.0\nk:\n- 600.0\n- 0.0\n- 319.5\n- 0.0\n- 601.0\n- 239.5\n"
                            "- 0.0\n- 0.0\n- 1.0\nr:\n- 1.0\n---\n"),
                       "ros2 topic echo");
  expect_common_camera(read("cam0:\n  camera_model: pinhole\n  distortion_coeffs: [-0.1, 0.02, 1e-5, 0.0]\n"
                            "  distortion_model: radtan\n  intrinsics: [600.0, 601.0, 319.5, 239.5]\n  resolution: [640, 480]\n"),
                       "Kalibr");
  EXPECT_THAT(message("cam0: {intrinsics: [1, 1, 1, 1]}\ncam1: {intrinsics: [1, 1, 1, 1]}\n"), HasSubstr("holds 2 cameras"));
}

TEST_F(CameraFile, SaysWhatToWriteWhereOnlyPythonCouldRead) {
  EXPECT_THAT(message("PK\x03\x04 and so on"), AllOf(HasSubstr("NumPy"), HasSubstr("tolist()")));
  EXPECT_THAT(message("dist: 0\nmtx: !!python/object/apply:numpy.core.multiarray._reconstruct\n  args: [0]\n"),
              AllOf(HasSubstr(path_ + ":2"), HasSubstr("yaml.dump"), HasSubstr("tolist()")));
}

TEST_F(CameraFile, NamesTheLineThatIsNoYaml) {
  EXPECT_THAT(message("%YAML:1.0\n---\nimage_width: 640\nimage_height: [480\ncamera_matrix: }\n"), HasSubstr(path_ + ":5"));
  // A few bytes of aliases that would be billions of numbers.
  std::string bomb = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 9; ++i) {
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [";
    for (int k = 0; k < 10; ++k) bomb += (k > 0 ? ", *a" : "*a") + std::to_string(i - 1);
    bomb += "]\n";
  }
  EXPECT_THAT(message(bomb), HasSubstr("nested too deeply"));
  EXPECT_THAT(message("camera_matrix: &a [*a]\n"), HasSubstr("nested too deeply"));
}

// --- another size ---------------------------------------------------------------------------------------------------------

class CameraFileFor : public CameraFile {
 protected:
  CameraModel camera(const std::string& text, int width_px, int height_px) {
    std::ofstream(path_, std::ios::binary) << text;
    return read_camera_file_for(path_, "clip.mp4", width_px, height_px, [&](const std::string& warning) { warned_ += warning; });
  }
  std::string refusal(const std::string& text, int width_px, int height_px) {
    try {
      camera(text, width_px, height_px);
    } catch (const Error& error) {
      return error.what();
    }
    return "(no error)";
  }
  std::string warned_;
};

TEST_F(CameraFileFor, TheSameSizeIsTakenAsItIs) {
  EXPECT_EQ(camera(kOpenCv, 640, 480), read(kOpenCv));
  EXPECT_EQ(warned_, "");
}

/// A ray meets the same place of the picture, measured in shares of its width from the outer edge.
TEST_F(CameraFileFor, TheSameAspectIsScaledFromEdgeToEdgeWithAWord) {
  const CameraModel own = read(kOpenCv), half = camera(kOpenCv, 320, 240);
  EXPECT_THAT(warned_, AllOf(HasSubstr("for pictures of 640x480; scaled to 320x240"), HasSubstr("cuts a part out")));
  EXPECT_EQ(half.width_px, 320);
  EXPECT_EQ(half.distortion, own.distortion);
  for (const double x : {-0.3, 0.0, 0.5}) {
    EXPECT_NEAR((own.fx_px * x + own.cx_px + 0.5) / 640, (half.fx_px * x + half.cx_px + 0.5) / 320, 1e-12);
    EXPECT_NEAR((own.fy_px * x + own.cy_px + 0.5) / 480, (half.fy_px * x + half.cy_px + 0.5) / 240, 1e-12);
  }
  EXPECT_NEAR(camera(with(with(kOpenCv, "640", "1920"), "480", "1080"), 854, 480).fx_px, 600.5 * 854 / 1920, 1e-9) << "rounded";
}

TEST_F(CameraFileFor, AnotherAspectIsRefusedWithWhatToDo) {
  for (const auto& [width_px, height_px] : {std::pair{1280, 720}, {480, 640}, {640, 488}, {640, 470}})
    EXPECT_THAT(refusal(kOpenCv, width_px, height_px),
                AllOf(HasSubstr(path_), HasSubstr("640x480"), HasSubstr("clip.mp4 is " + std::to_string(width_px)),
                      HasSubstr("another aspect"), HasSubstr("--fov")));
}

TEST_F(CameraFileFor, AFileWithoutASizeIsForThePicturesWhoseMiddleItHas) {
  const std::string bare = "mtx: [[600, 0, 319.5], [0, 601, 239.5], [0, 0, 1]]\ndist: [-0.1, 0.02, 1e-5, 0]\n";
  expect_common_camera(camera(bare, 640, 480), "bare");
  EXPECT_THAT(warned_, HasSubstr("says no size"));
  EXPECT_THAT(refusal(bare, 1280, 720), AllOf(HasSubstr("(319.5, 239.5)"), HasSubstr("add image_width and image_height")));
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
