// Every command draws the same frame: whichever way a frame comes to be drawn, its bytes are the same.
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/app/commands/overlay_command.hpp"

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

/// Three frames of a shipped recording with metal, as the renderer that is the parameter draws them.
class EachRendererDrawsTheSameBytes : public OverlayCommand, public ::testing::WithParamInterface<std::string> {
 protected:
  static std::map<std::string, std::string> pretending(int cores) {
    return {{"LD_PRELOAD", CATCHLIGHT_PRETENDED_CORES}, {"PRETENDED_CORES", std::to_string(cores)}};
  }

  /// The frames' files. `cache` names what keeps the baked light.
  std::vector<std::string> frames(int cores, const std::string& range, const std::string& cache) {
    const std::string output = folder_.path("out" + std::to_string(++runs_));
    fs::create_directory(output);
    std::map<std::string, std::string> environment = pretending(cores);
    environment["XDG_CACHE_HOME"] = folder_.path(cache);
    const CommandResult result =
        run_catchlight({"overlay", copy_, "-o", output + "/%04d.png", "--frames", range, "--renderer", GetParam(),
                        "--quality.rays=16", "--quality.bands=3", "--quality.bounces=1", "--quality.receiver_points=16",
                        "--quality.reflection_rays=4", "--quality.light_samples=8"},
                       environment);
    EXPECT_EQ(result.exit_code, 0) << result.error;
    std::vector<fs::path> files(fs::directory_iterator(output), fs::directory_iterator{});
    std::ranges::sort(files);
    std::vector<std::string> bytes;
    for (const fs::path& file : files) bytes.push_back(read_text(file));
    return bytes;
  }

  int runs_ = 0;
  const std::string copy_ = copied_recording(3, "gloss");
};

TEST_P(EachRendererDrawsTheSameBytes, HoweverManyCoresInChunksAndOnceMore) {
  EXPECT_THAT(run_catchlight({"info"}, pretending(13)).output, ::testing::HasSubstr("13 threads"));
  const std::vector<std::string> whole = frames(2, "0:3", "cache of 2");
  ASSERT_EQ(whole.size(), 3u);
  EXPECT_FALSE(whole[0] == whole[1]);
  EXPECT_TRUE(frames(2, "0:3", "cache of 2") == whole) << "once more";
  EXPECT_TRUE(frames(1, "0:3", "cache of 1") == whole) << "one core";
  EXPECT_TRUE(frames(4, "0:3", "cache of 4") == whole) << "four cores";
  std::vector<std::string> joined = frames(2, "0:2", "cache of 2");
  const std::vector<std::string> last = frames(4, "2:3", "cache of 2");
  joined.insert(joined.end(), last.begin(), last.end());
  EXPECT_TRUE(joined == whole) << "in chunks";
}

INSTANTIATE_TEST_SUITE_P(Renderers, EachRendererDrawsTheSameBytes, ::testing::Values("cpu", "gl"),
                         [](const auto& each) { return each.param; });

}  // namespace
}  // namespace catchlight::tests
