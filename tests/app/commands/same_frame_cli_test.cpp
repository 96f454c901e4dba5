// Every command draws the same frame: whichever way a frame comes to be drawn, its bytes are the same.
#include <gmock/gmock.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/support/run_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::tests {
namespace {

namespace fs = std::filesystem;

/// Two frames of a shipped recording, their truth, and settings that make drawing quick. Truth has no grain and no glare, so
/// replay draws none: neither do the others here.
class EveryCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    const fs::path matte = fs::path(CATCHLIGHT_SOURCE_DIR) / "recordings/matte", shot = recording_;
    for (const auto& [number, name] : {std::pair{"0000.png", "0000.png"}, {"0016.png", "0001.png"}}) {
      for (const auto& [from, to] : {std::pair{"plate_clean", "plate"}, {"truth", "truth"}, {"mask", "mask"}}) {
        fs::create_directories(shot / to);
        fs::copy(matte / from / number, shot / to / name);
      }
    }
    for (const char* file : {"camera.yaml", "scene.toml", "object.glb", "probe.exr"}) fs::copy(matte / file, shot / file);
  }

  void run(const std::string& command, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {command, recording_};
    for (const char* setting : {"quality.rays 16", "quality.bands 3", "quality.bounces 0", "quality.light_samples 8",
                                "lens.noise false", "glare.enabled false"}) {
      const std::string text = setting;
      arguments.push_back("--" + text.substr(0, text.find(' ')));
      arguments.push_back(text.substr(text.find(' ') + 1));
    }
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult result = run_catchlight(arguments);
    EXPECT_NE(result.exit_code, 2) << result.error;
  }

  cv::Mat second_frame(const std::string& name, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"-o", folder_.path(name + ".%04d.png")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    run("overlay", arguments);
    return cv::imread(folder_.path(name + ".0001.png"));
  }

  static bool same(const cv::Mat& a, const cv::Mat& b) {
    return a.size() == b.size() && !a.empty() && cv::norm(a, b, cv::NORM_INF) == 0;
  }

  TemporaryFolder folder_;
  const std::string recording_ = folder_.path("shot");
};

TEST_F(EveryCommand, DrawsTheSameFrame) {
  const cv::Mat whole = second_frame("whole", {});
  EXPECT_FALSE(same(whole, cv::imread(recording_ + "/plate/0001.png"))) << "nothing was drawn";

  EXPECT_TRUE(same(second_frame("chunk", {"--frames", "1:2"}), whole)) << "overlay --frames";

  run("track", {"-o", folder_.path("track.csv")});
  EXPECT_TRUE(same(second_frame("tracked", {"--track", folder_.path("track.csv")}), whole)) << "track, then overlay --track";

  run("replay", {"-o", folder_.path("sheets")});
  const cv::Mat sheet = cv::imread(folder_.path("sheets/shot.png"));
  ASSERT_EQ(sheet.size(), cv::Size(4 * whole.cols, 2 * whole.rows));
  EXPECT_TRUE(same(sheet(cv::Rect(whole.cols, whole.rows, whole.cols, whole.rows)), whole)) << "replay";
}

}  // namespace
}  // namespace catchlight::tests
