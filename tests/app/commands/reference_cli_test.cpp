// `catchlight reference` as users run it: a path-traced frame, and what is said about bad input.
#include <gmock/gmock.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "catchlight/image.hpp"
#include "catchlight/plate.hpp"
#include "catchlight/response.hpp"
#include "render/image/image_io.hpp"
#include "tests/support/run_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::tests {
namespace {

using ::testing::HasSubstr;

class ReferenceCommand : public ::testing::Test {
 protected:
  /// Runs `reference` on the shipped recording at its known poses: frame 0, a light path a pixel.
  CommandResult reference(std::vector<std::string> more, const std::string& recording = kMatte) {
    std::vector<std::string> arguments = {"reference", recording, "--samples", "1", "--bounces", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_catchlight(arguments);
  }

  void expect_refused(const CommandResult& result, int exit_code, const std::string& message) {
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_THAT(result.error, HasSubstr("catchlight: error: "));
    EXPECT_THAT(result.error, HasSubstr(message));
    EXPECT_EQ(folder_.names(), std::vector<std::string>{}) << "nothing is left behind";
  }

  static constexpr const char* kMatte = CATCHLIGHT_SOURCE_DIR "/recordings/matte";
  const std::string poses_ = std::string(kMatte) + "/poses.csv";
  TemporaryFolder folder_;
};

TEST_F(ReferenceCommand, ObjectIsThereAndWhatItDoesNotReachIsThePlate) {
  const std::string out = folder_.path("traced.png");
  const CommandResult result =
      run_catchlight({"reference", kMatte, "--frame", "0", "-o", out, "--track", poses_, "--samples", "16"});
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.error, HasSubstr("traced.png"));
  const cv::Mat traced = cv::imread(out), truth = cv::imread(std::string(kMatte) + "/truth/0000.png"),
                plate = cv::imread(std::string(kMatte) + "/plate_clean/0000.png");
  ASSERT_EQ(traced.size(), plate.size());
  EXPECT_GT(cv::norm(traced, plate, cv::NORM_INF), 50) << "the object";
  cv::Mat ours, theirs;
  cv::absdiff(traced, truth, ours);
  cv::absdiff(plate, truth, theirs);
  cv::Mat green, changed;
  cv::extractChannel(theirs, green, 1);
  changed = green > 20;
  EXPECT_GT(cv::countNonZero(changed), 1000);
  EXPECT_LT(cv::mean(ours, changed)[1], 0.25 * cv::mean(theirs, changed)[1]) << "where the truth has the object or its shadow";
}

TEST_F(ReferenceCommand, ExrIsExposedLinearLight) {
  ASSERT_EQ(reference({"--frame", "0", "-o", folder_.path("a.png"), "--track", poses_}).exit_code, 0);
  ASSERT_EQ(reference({"--frame", "0", "-o", folder_.path("a.exr"), "--track", poses_}).exit_code, 0);
  const cv::Mat coded = cv::imread(folder_.path("a.png"));
  const Image linear = render::read_exr(folder_.path("a.exr"));
  for (const int x : {10, 320, 600})
    EXPECT_NEAR(255 * code_from_linear(TransferFunction::srgb, linear.pixel(x, 240)[0]), coded.at<cv::Vec3b>(240, x)[2], 0.6);
}

/// `auto` exposes the finished picture anew; the light that a reference holds is that before it, the footage's own black
/// included.
TEST_F(ReferenceCommand, ExposureAutoHasTheLightOfMatch) {
  for (const std::string mode : {"match", "auto"})
    ASSERT_EQ(
        reference({"--frame", "0", "-o", folder_.path(mode + ".exr"), "--track", poses_, "--exposure.mode", mode}).exit_code, 0);
  EXPECT_EQ(render::read_exr(folder_.path("auto.exr")).data, render::read_exr(folder_.path("match.exr")).data);
}

TEST_F(ReferenceCommand, FrameThatIsNotThereSaysHowManyThereAre) {
  expect_refused(reference({"--frame", "99", "-o", folder_.path("x.png"), "--track", poses_}), 1,
                 "there is no frame 99; it has 36 from 0");
}

TEST_F(ReferenceCommand, FrameThatIsNoNumberIsAUsageError) {
  expect_refused(reference({"--frame", "last", "-o", folder_.path("x.png")}), 2, "--frame");
  expect_refused(reference({"-o", folder_.path("x.png")}), 2, "--frame is required");
}

TEST_F(ReferenceCommand, FrameWithoutTagIsNamed) {
  const std::string lost = "frame,time_s,found,r00,r01,r02,r10,r11,r12,r20,r21,r22,tx,ty,tz\n0,0,0,,,,,,,,,,,,\n";
  const TemporaryFolder other;
  const std::string track = other.write("track.csv", lost);
  expect_refused(reference({"--frame", "0", "-o", folder_.path("x.png"), "--track", track}), 1,
                 "the tag is not found in frame 0");
}

TEST_F(ReferenceCommand, MissingRecordingIsNamed) {
  expect_refused(reference({"--frame", "0", "-o", folder_.path("x.png")}, "/nowhere/shot"), 1, "/nowhere/shot");
}

TEST_F(ReferenceCommand, ExistingOutputIsKeptWithoutY) {
  const std::string out = folder_.write("x.png", "precious");
  const CommandResult result = reference({"--frame", "0", "-o", out, "--track", poses_});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.error, HasSubstr("exists already; pass -y"));
  EXPECT_EQ(read_text(out), "precious");
}

TEST_F(ReferenceCommand, OtherExtensionsAreRefusedBeforeAnyWork) {
  expect_refused(reference({"--frame", "0", "-o", folder_.path("x.mp4")}), 2, "expected a name that ends in .png");
}

TEST(CodeFromLinear, IsTheInverseOfLinearFromCode) {
  for (const TransferFunction transfer : {TransferFunction::srgb, TransferFunction::linear, TransferFunction::gamma22,
                                          TransferFunction::gamma28, TransferFunction::pq, TransferFunction::hlg})
    for (const double code : {0.0, 0.01, 0.04, 0.2, 0.5, 0.75, 1.0})
      EXPECT_NEAR(code_from_linear(transfer, linear_from_code(transfer, code)), code, 2e-6) << static_cast<int>(transfer);
  EXPECT_EQ(code_from_linear(TransferFunction::pq, -1), code_from_linear(TransferFunction::pq, 0));
}

}  // namespace
}  // namespace catchlight::tests
