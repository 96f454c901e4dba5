// Exposure "auto" and looks, as users run them.
#include <gmock/gmock.h>

#include <cstdlib>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "app/settings/look.hpp"
#include "app/settings/parameters.hpp"
#include "render/probe/probe.hpp"
#include "render/settings.hpp"
#include "tests/support/run_command.hpp"
#include "tests/support/scene_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::tests {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

TEST(Look, StandsBeforeTheFirstSectionAndLeavesWhatIsSetByHand) {
  app::SceneSettings scene = read_scene("look = \"classic\"\n[glare]\nbloom_strength = 0.5\n");
  app::apply_look(scene, scene.by_hand);
  EXPECT_EQ(scene.glare.bloom_strength, 0.5);
  EXPECT_EQ(scene.glare.streak_strength, 0.2);
  EXPECT_EQ(scene.exposure.key, 0.72);
  EXPECT_FALSE(scene.is_by_hand("exposure.key")) << "a look is nobody's hand";
  EXPECT_FALSE(app::tone_settings(scene).has_white_point);
}

TEST(Look, CameraChangesNothing) {
  app::SceneSettings scene;
  app::apply_look(scene, {});
  for (const app::Parameter& parameter : app::parameters())
    EXPECT_EQ(app::parameter_text(scene, parameter), app::parameter_text({}, parameter)) << parameter.key;
}

TEST(Look, AnUnknownOneIsRefusedWithTheNames) {
  EXPECT_THAT(scene_refusal("look = \"modern\"\n"), HasSubstr("look is \"modern\"; expected \"camera\" or \"classic\""));
}

class AutoExposureCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string shipped = CATCHLIGHT_SOURCE_DIR "/recordings/matte";
    fs::create_directories(recording_ + "/plate");
    for (const char* file : {"camera.yaml", "scene.toml", "object.glb"}) fs::copy(shipped + "/" + file, recording_ + "/" + file);
    const render::Probe probe = render::load_probe(shipped + "/probe.exr", {}, {});
    render::save_probe(recording_ + "/probe.exr", render::convert(probe, render::ProbeLayout::latlong, 64));
    // Four frames as they are, then a lamp goes out; the last is without a tag.
    ASSERT_EQ(std::system(("ffmpeg -v error -nostdin -i " + shipped + "/video.mp4 -frames:v 7 -start_number 0 " + recording_ +
                           "/plate/%04d.png")
                              .c_str()),
              0);
    for (int frame = 4; frame < 7; ++frame) {
      const cv::Mat picture = cv::imread(file("recording/plate", frame));
      cv::imwrite(file("recording/plate", frame),
                  frame < 6 ? cv::Mat(picture * 0.4) : cv::Mat(picture.size(), CV_8UC3, cv::Scalar::all(30)));
    }
  }

  std::string file(const std::string& folder, int frame) const {
    return folder_.path(folder + "/000" + std::to_string(frame) + ".png");
  }

  CommandResult overlay(const std::string& out, std::vector<std::string> more) {
    fs::create_directories(folder_.path(out));
    std::vector<std::string> arguments = {"overlay", recording_, "-o", folder_.path(out + "/%04d.png")};
    for (const char* option : {"--quality.rays=64", "--quality.bands=2", "--quality.bounces=0", "--quality.receiver_points=16",
                               "--quality.reflection_rays=0", "--quality.samples=1"})
      arguments.push_back(option);
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_catchlight(arguments, {{"XDG_CACHE_HOME", folder_.path("cache")}});
  }

  double brightness(const std::string& folder, int frame) const { return cv::mean(cv::imread(file(folder, frame)))[1]; }

  TemporaryFolder folder_;
  std::string recording_ = folder_.path("recording");
};

TEST_F(AutoExposureCommand, ChunksAreTheSameBytesAsOneRun) {
  ASSERT_EQ(overlay("whole", {"--exposure.mode=auto", "--track-out", folder_.path("track.csv")}).exit_code, 0);
  for (const char* range : {"0:3", "3:7"})
    ASSERT_EQ(overlay("chunks", {"--exposure.mode=auto", "--frames", range, "--track", folder_.path("track.csv")}).exit_code, 0);
  for (int frame = 0; frame < 7; ++frame) EXPECT_EQ(read_text(file("whole", frame)), read_text(file("chunks", frame))) << frame;
}

TEST_F(AutoExposureCommand, AdaptsAndDoesNotFlashWhereTheTagIsLost) {
  ASSERT_EQ(overlay("slow", {"--exposure.mode=auto"}).exit_code, 0);
  ASSERT_EQ(overlay("quick", {"--exposure.mode=auto", "--exposure.adapt_dark_s=0"}).exit_code, 0);
  EXPECT_NEAR(brightness("quick", 4), brightness("slow", 4), 0.01) << "the first dark frame is drawn as before it";
  EXPECT_LT(brightness("slow", 5), 0.7 * brightness("slow", 3));
  EXPECT_GT(brightness("quick", 5), 0.9 * brightness("slow", 3)) << "adapted";
  // A flat frame without a tag, adapted to what came before: brighter than it is, not handed on as it is.
  EXPECT_GT(brightness("quick", 6), 45);
}

TEST_F(AutoExposureCommand, ClassicIsASetOfSettingsWhichOneSetByHandWins) {
  ASSERT_EQ(overlay("classic", {"--look=classic", "--frames=0"}).exit_code, 0);
  ASSERT_EQ(overlay("matched", {"--look=classic", "--exposure.mode=match", "--glare.enabled=false", "--frames=0"}).exit_code, 0);
  ASSERT_EQ(overlay("camera", {"--glare.enabled=false", "--frames=0"}).exit_code, 0);
  EXPECT_GT(std::abs(brightness("classic", 0) - brightness("camera", 0)), 5);
  const cv::Mat matched = cv::imread(file("matched", 0)), camera = cv::imread(file("camera", 0));
  EXPECT_LE(cv::norm(matched, camera, cv::NORM_INF), 1) << "without exposure and glare nothing of the look is left";
}

TEST_F(AutoExposureCommand, AnUnknownLookIsRefusedWithTheNames) {
  const CommandResult result = overlay("none", {"--look=modern"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.error, HasSubstr("--look is \"modern\"; expected \"camera\" or \"classic\""));
}

}  // namespace
}  // namespace catchlight::tests
