// Camera responses from files, against the curves they were made of.
#include "app/response/response_file.hpp"
#include "app/response/response_points.hpp"
#include "catchlight/error.hpp"
#include "catchlight/response.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <opencv2/photo.hpp>
#include <random>

namespace catchlight::app {
namespace {

using ::testing::HasSubstr;
using tests::message_of;
using tests::TemporaryFolder;

class ResponseFile : public ::testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path(name)) << text;
    return folder_.path(name);
  }
  std::shared_ptr<const ResponseCurve> load(const std::string& name) {
    return load_response(name, [this](const std::string& warning) { warnings_.push_back(warning); })->curve;
  }
  std::string refusal(const std::string& name, const std::string& text) {
    const std::string path = file(name, text);
    return message_of<Error>([&] { load(path); });
  }

  TemporaryFolder folder_;
  std::vector<std::string> warnings_;
};

/// The curve of a camera with toe and shoulder, made up; other than sRGB's.
double light_of(double code) {
  return (0.12 * code + 0.88 * std::pow(code, 2.6)) / (1 + 0.15 * (1 - code));
}

void expect_exact_round_trip(const ResponseCurve& curve, int max_code) {
  for (int channel = 0; channel < 3; ++channel)
    for (int code = 0; code <= max_code; ++code) {
      const double normalised = static_cast<double>(code) / max_code;
      ASSERT_NEAR(curve.code_from_linear(curve.linear_from_code(normalised, channel), channel), normalised, 1e-12) << code;
    }
}

TEST_F(ResponseFile, NamesOfFormulas) {
  EXPECT_FALSE(load_response("footage", {}));
  EXPECT_EQ(load_response("srgb", {})->transfer, TransferFunction::srgb);
  EXPECT_EQ(load_response("linear", {})->transfer, TransferFunction::linear);
  EXPECT_FALSE(load_response("linear", {})->curve);
}

TEST_F(ResponseFile, GammaIsExactAtEveryCodeOf8And16Bits) {
  const auto curve = load("gamma:2.4");
  for (const int max_code : {255, 65535})
    for (int code = 0; code <= max_code; ++code) {
      const double normalised = static_cast<double>(code) / max_code, light = std::pow(normalised, 2.4);
      ASSERT_NEAR(curve->linear_from_code(normalised, code % 3), light, 1e-7 * light + 1e-15) << code;
    }
  expect_exact_round_trip(*curve, 255);
  expect_exact_round_trip(*curve, 65535);
}

TEST_F(ResponseFile, GammaBeyondReasonIsRefused) {
  for (const char* name : {"gamma:0", "gamma:9", "gamma:", "gamma:x", "gamma:nan"})
    EXPECT_THAT(message_of<Error>([&] { load(name); }), HasSubstr(name));
}

TEST_F(ResponseFile, ACsvOfEightBitCodesScaledToWhite) {
  std::string text = "code,r,g,b\n";
  for (int code = 0; code < 256; ++code) {
    const double light = light_of(code / 255.0);
    text += std::to_string(code) + "," + std::to_string(7 * light) + "," + std::to_string(5 * light) + "," +
            std::to_string(3 * light) + "\n";
  }
  const auto curve = load(file("camera.csv", text));
  EXPECT_TRUE(warnings_.empty());
  EXPECT_EQ(curve->size(), 256u);
  for (int channel = 0; channel < 3; ++channel)
    for (int code = 0; code < 256; ++code)
      EXPECT_NEAR(curve->linear_from_code(code / 255.0, channel), light_of(code / 255.0), 1e-6);
  expect_exact_round_trip(*curve, 255);
  expect_exact_round_trip(*curve, 65535);
}

TEST_F(ResponseFile, ACsvOfAFewCodesHasStraightLinesBetween) {
  const auto curve = load(file("camera.csv", "0,0,0,0\n100,0.2,0.1,0.3\n400,1,1,1\n"));
  EXPECT_NEAR(curve->linear_from_code(0.25, 0), 0.2, 1e-6);
  EXPECT_NEAR(curve->linear_from_code(0.625, 1), 0.55, 1e-6);
  expect_exact_round_trip(*curve, 65535);
}

TEST_F(ResponseFile, ALogarithmicCubeKeepsItsOwnLight) {
  // Code to light of a curve with 5 stops above white, black at code 0.1 and a little less light below.
  const auto light = [](double code) { return code < 0.1 ? (code - 0.1) * 0.02 : (std::exp2(10 * (code - 0.1)) - 1) / 31; };
  std::string text =
      "TITLE \"some log to linear\"\n# made up\nLUT_1D_SIZE 4096\nDOMAIN_MIN 0.0 0.0 0.0\nDOMAIN_MAX 1.0 1.0 1.0\n";
  for (int i = 0; i < 4096; ++i) {
    const std::string value = std::to_string(light(i / 4095.0));
    text += value + " " + value + " " + value + "\n";
  }
  const auto curve = load(file("log.cube", text));
  EXPECT_NEAR(curve->linear_from_code(1, 1), light(1), 1e-4) << "beyond 1, as the file says";
  EXPECT_NEAR(curve->linear_from_code(0.6, 1), 1, 0.001);
  EXPECT_LT(curve->linear_from_code(0, 1), 0) << "and below 0";
  expect_exact_round_trip(*curve, 255);
  expect_exact_round_trip(*curve, 65535);
}

TEST_F(ResponseFile, LightBeyondTheCurvesEndsHasItsCode) {
  const auto curve = load(file("camera.csv", "0,0,0,0\n1,0.5,0.2,0.2\n2,1,1,1\n"));
  EXPECT_NEAR(curve->code_from_linear(2, 0), 2, 1e-6);
  EXPECT_NEAR(curve->code_from_linear(-0.5, 0), -0.5, 1e-6);
  EXPECT_NEAR(curve->linear_from_code(1.2, 1), 1.32, 1e-6);
}

TEST_F(ResponseFile, ATinyDipIsMendedAndSaid) {
  std::string text;
  for (int code = 0; code < 256; ++code) {
    const double light = light_of(code / 255.0) - (code == 254 ? 0.02 : 0.0);
    text += std::to_string(code) + "," + std::to_string(light) + "," + std::to_string(light) + "," + std::to_string(light) + "\n";
  }
  const auto curve = load(file("camera.csv", text));
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_THAT(warnings_[0], HasSubstr("mended"));
  EXPECT_THAT(warnings_[0], HasSubstr("red"));
  expect_exact_round_trip(*curve, 255);
  for (int code = 1; code < 256; ++code)
    EXPECT_GT(curve->linear_from_code(code / 255.0, 0), curve->linear_from_code((code - 1) / 255.0, 0)) << code;
}

TEST_F(ResponseFile, ACurveThatFallsIsRefused) {
  EXPECT_THAT(refusal("a.csv", "0,0,0,0\n1,0.6,0.5,0.5\n2,0.3,0.7,0.7\n3,1,1,1\n"),
              AllOf(HasSubstr("a.csv"), HasSubstr("red does not rise"), HasSubstr("calibrate again")));
  EXPECT_THAT(refusal("b.csv", "0,1,1,1\n1,0,0,0\n"), HasSubstr("does not rise"));
  EXPECT_THAT(refusal("c.csv", "0,1,1,1\n1,1,1,1\n"), HasSubstr("does not rise"));
}

TEST_F(ResponseFile, ACurveTheWrongWayRoundIsWarnedOf) {
  std::string text = "LUT_1D_SIZE 64\n";
  for (int i = 0; i < 64; ++i) {
    const std::string value = std::to_string(std::sqrt(i / 63.0));
    text += value + " " + value + " " + value + "\n";
  }
  load(file("inverse.cube", text));
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_THAT(warnings_[0], HasSubstr("from light to codes"));
}

TEST_F(ResponseFile, BadFilesAreRefusedByName) {
  EXPECT_THAT(message_of<Error>([&] { load(folder_.path("none.csv")); }), HasSubstr("none.csv"));
  EXPECT_THAT(message_of<Error>([&] { load("s-log"); }), HasSubstr("\"gamma:2.4\""));
  EXPECT_THAT(refusal("a.csv", "0,0,0,0\n1,1,1\n"), HasSubstr("a.csv:2: expected four numbers"));
  EXPECT_THAT(refusal("b.csv", "0,0,0,0\n2,1,1,1\n1,2,2,2\n"), HasSubstr("b.csv:3: code 1; expected codes that rise"));
  EXPECT_THAT(refusal("c.csv", ""), HasSubstr("0 codes"));
  EXPECT_THAT(refusal("d.csv", "0,0,0,0\n1,nan,1,1\n"), HasSubstr("d.csv:2"));
  EXPECT_THAT(refusal("a.cube", "LUT_3D_SIZE 2\n"), HasSubstr("3D LUT"));
  EXPECT_THAT(refusal("b.cube", "LUT_1D_SIZE 3\n0 0 0\n1 1 1\n"), HasSubstr("LUT_1D_SIZE is 3, but 2 rows"));
  EXPECT_THAT(refusal("c.cube", "LUT_1D_SIZE 2\nDOMAIN_MAX 4 4 4\n0 0 0\n1 1 1\n"), HasSubstr("DOMAIN_MAX"));
  EXPECT_THAT(refusal("d.cube", "LUT_1D_SIZE 2\n0 0 0\nx 1 1\n"), HasSubstr("d.cube:3"));
  EXPECT_THAT(refusal("a.yaml", "%YAML:1.0\n---\nx: 3\n"), HasSubstr("holds 0 matrices"));
  EXPECT_THAT(refusal("b.yaml", "no yaml"), HasSubstr("b.yaml: is not YAML or XML as cv::FileStorage writes it"));
  EXPECT_THAT(refusal("empty.yaml", ""), HasSubstr("empty.yaml"));
  EXPECT_THAT(refusal("empty.cube", ""), HasSubstr("empty.cube"));
  EXPECT_THAT(refusal("one.csv", "0,0,0,0\n"), HasSubstr("holds 1 codes"));
}

TEST_F(ResponseFile, AMatrixThatIsNoCurveIsRefusedByName) {
  const auto refused = [this](const std::string& name, const cv::Mat& matrix) {
    cv::FileStorage storage(folder_.path(name), cv::FileStorage::WRITE);
    storage.write("response", matrix);
    storage.release();
    return message_of<Error>([&] { load(folder_.path(name)); });
  };
  EXPECT_THAT(refused("two.yaml", cv::Mat::ones(256, 1, CV_32FC2)), AllOf(HasSubstr("two.yaml"), HasSubstr("2 channels")));
  EXPECT_THAT(refused("wide.yaml", cv::Mat::ones(256, 7, CV_32F)), AllOf(HasSubstr("wide.yaml"), HasSubstr("256 x 7")));
  cv::Mat curve(256, 1, CV_32F);
  for (int code = 0; code < 256; ++code) curve.at<float>(code) = static_cast<float>(code);
  curve.at<float>(100) = std::nanf("");
  EXPECT_THAT(refused("nan.yaml", curve), AllOf(HasSubstr("nan.yaml"), HasSubstr("code 100 is not a finite")));
  curve.at<float>(100) = std::numeric_limits<float>::infinity();
  EXPECT_THAT(refused("inf.xml", curve), AllOf(HasSubstr("inf.xml"), HasSubstr("code 100 is not a finite")));
  curve.at<float>(100) = 30;
  EXPECT_THAT(refused("falls.yaml", curve), AllOf(HasSubstr("falls.yaml"), HasSubstr("does not rise")));
}

TEST_F(ResponseFile, OpenCvsDebevecRecoversAKnownCurve) {
  // A ramp of light in each channel, photographed eight times a stop apart with the known curve and noise.
  constexpr int kSide = 64;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> stops(-9, 0);
  std::normal_distribution<double> noise(0, 0.3);
  cv::Mat light(kSide, kSide, CV_64FC3);
  for (int i = 0; i < kSide * kSide; ++i)
    for (int c = 0; c < 3; ++c) light.at<cv::Vec3d>(i / kSide, i % kSide)[c] = std::exp2(stops(random));
  std::vector<double> code_light;
  for (int i = 0; i <= 65536; ++i) code_light.push_back(light_of(i / 65536.0));
  std::vector<cv::Mat> photographs;
  std::vector<float> times;
  for (int i = 0; i < 8; ++i) {
    times.push_back(static_cast<float>(std::exp2(i)));
    cv::Mat picture(kSide, kSide, CV_8UC3);
    for (int p = 0; p < kSide * kSide; ++p)
      for (int c = 0; c < 3; ++c) {
        const double exposed = light.at<cv::Vec3d>(p / kSide, p % kSide)[c] * static_cast<double>(times.back());
        const auto at = std::lower_bound(code_light.begin(), code_light.end(), exposed) - code_light.begin();
        picture.at<cv::Vec3b>(p / kSide, p % kSide)[c] =
            cv::saturate_cast<std::uint8_t>(255 * static_cast<double>(at) / 65536 + noise(random));
      }
    photographs.push_back(picture);
  }
  cv::Mat response;
  cv::createCalibrateDebevec(200, 30, true)->process(photographs, response, times);
  const std::string path = folder_.path("camera.yaml");
  cv::FileStorage storage(path, cv::FileStorage::WRITE);
  storage.write("response", response);
  storage.release();

  const auto curve = load(path);
  // The scale is the last code's, where hardly a sample is; what matters for matching is the shape below.
  for (int channel = 0; channel < 3; ++channel) {
    const double scale = curve->linear_from_code(128 / 255.0, channel) / light_of(128 / 255.0);
    for (int code = 24; code <= 240; code += 8)
      EXPECT_NEAR(curve->linear_from_code(code / 255.0, channel) / (scale * light_of(code / 255.0)), 1, 0.04)
          << code << " channel " << channel;
  }
  expect_exact_round_trip(*curve, 255);
}

TEST(Isotonic, PoolsWhatFallsAndKeepsWhatRises) {
  EXPECT_EQ(isotonic({1, 2, 3}), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(isotonic({1, 4, 2, 5}), (std::vector<double>{1, 3, 3, 5}));
  EXPECT_EQ(isotonic({3, 2, 1}), (std::vector<double>{2, 2, 2}));
  EXPECT_TRUE(isotonic({}).empty());
}

}  // namespace
}  // namespace catchlight::app
