// Vignetting is the camera's: every command that draws has it.
#include <gmock/gmock.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "catchlight/image.hpp"
#include "catchlight/track.hpp"
#include "render/image/image_io.hpp"
#include "tests/support/run_command.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tracking/track_file.hpp"

namespace catchlight::tests {
namespace {

namespace fs = std::filesystem;

/// The first frame of a shipped recording, as if its lens passed 1 + 20 r^2 of the light: so much that it shows right beside the
/// tag.
class VignettedRecording : public ::testing::Test {
 protected:
  void SetUp() override {
    const fs::path matte = fs::path(CATCHLIGHT_SOURCE_DIR) / "recordings/matte";
    for (const char* folder : {"plate", "truth", "mask"}) fs::create_directories(fs::path(recording_) / folder);
    fs::copy(matte / "plate_clean/0000.png", fs::path(recording_) / "plate/0000.png");
    for (const char* file : {"truth/0000.png", "mask/0000.png", "poses.csv", "scene.toml", "object.glb", "probe.exr"})
      fs::copy(matte / file, fs::path(recording_) / file);
    folder_.write("shot/camera.yaml", read_text((matte / "camera.yaml").string()) + "vignetting: [ 20., 0., 0. ]\n");
  }

  CommandResult run(const std::string& command, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {command, recording_, "--quality.rays", "16", "--quality.bands", "3"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_catchlight(arguments);
  }

  cv::Mat overlaid(const std::string& name, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"-o",   folder_.path(name + ".%04d.png"), "--glare.enabled", "false", "--lens.noise",
                                          "false"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult result = run("overlay", arguments);
    EXPECT_EQ(result.exit_code, 0) << result.error;
    return cv::imread(folder_.path(name + ".0000.png"));
  }

  Image traced(const std::string& name, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"-o",
                                          folder_.path(name + ".exr"),
                                          "--frame",
                                          "0",
                                          "--track",
                                          recording_ + "/poses.csv",
                                          "--samples",
                                          "1",
                                          "--bounces",
                                          "0",
                                          "--receiver.plane",
                                          "none",
                                          "--exposure.mode",
                                          "fixed"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult result = run("reference", arguments);
    EXPECT_EQ(result.exit_code, 0) << result.error;
    return render::read_exr(folder_.path(name + ".exr"));
  }

  TemporaryFolder folder_;
  const std::string recording_ = folder_.path("shot");
};

TEST_F(VignettedRecording, ReplayComparesThePictureThatOverlayMakes) {
  run("replay", {"-o", folder_.path("sheets")});  // nothing is expected of the recording yet, which it says
  const cv::Mat sheet = cv::imread(folder_.path("sheets/shot.png")), expected = overlaid("with", {}),
                even = overlaid("without", {"--lens.vignetting", "false"});
  ASSERT_EQ(sheet.cols, 4 * expected.cols);
  ASSERT_GT(cv::norm(expected, even, cv::NORM_INF), 3) << "it shows";
  const cv::Mat replayed = sheet(cv::Rect(expected.cols, 0, expected.cols, expected.rows));
  EXPECT_EQ(cv::norm(replayed, expected, cv::NORM_INF), 0);
}

TEST_F(VignettedRecording, ReferenceScalesTheObjectAgainstTheTag) {
  const Image scaled = traced("with", {}), even = traced("without", {"--lens.vignetting", "false"});
  const glm::dvec2 middle(319.5, 239.5);
  const auto passed = [&](const glm::dvec2& px) { return 1 + 20 * glm::dot(px - middle, px - middle) / (320 * 320 + 240 * 240); };
  const TrackRow row = tracking::read_track_file(recording_ + "/poses.csv").rows.front();
  const glm::dvec3 tag = row.camera_from_tag.translation_m;
  const glm::dvec2 tag_px = middle + 600.0 * glm::dvec2(tag) / tag.z;
  cv::Mat inside;
  cv::erode(cv::imread(recording_ + "/mask/0000.png", cv::IMREAD_GRAYSCALE), inside, cv::Mat::ones(9, 9, CV_8U));
  int compared = 0;
  double off = 0;
  for (int y = 0; y < inside.rows; ++y) {
    for (int x = 0; x < inside.cols; ++x) {
      if (inside.at<std::uint8_t>(y, x) != 255 || even.pixel(x, y)[1] < 0.01) continue;
      const double ratio = scaled.pixel(x, y)[1] / even.pixel(x, y)[1];
      off = std::max(off, std::abs(ratio / (passed({x, y}) / passed(tag_px)) - 1));
      ++compared;
    }
  }
  EXPECT_GT(compared, 1000);
  EXPECT_LT(off, 2e-3) << "two roundings to half precision";
}

}  // namespace
}  // namespace catchlight::tests
