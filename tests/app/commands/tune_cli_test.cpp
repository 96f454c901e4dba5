// The window as scripts use it, without a screen.
#include <gmock/gmock.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <regex>
#include <sstream>

#include "tests/app/commands/tuned_recording.hpp"

namespace catchlight::tests {
namespace {

using ::testing::HasSubstr;

const std::string kRecordings = std::string(CATCHLIGHT_SOURCE_DIR) + "/recordings/";

using TuneCli = TunedRecording;

TEST_F(TuneCli, SavesExactlyWhatWasTurnedAndOverlayDrawsWhatWasSeen) {
  const std::string before = text_of(path("scene.toml"));
  const CommandResult result =
      run("wait\nseek 5\nset probe.yaw_deg 40\nset glare.bloom_strength 0.25\nset probe.ev 0.5\n"
          "click undo\nexpect probe.ev 0\nwait\npicture " +
          path("seen.png") + "\nsave\nquit\n");
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const std::string after = text_of(path("scene.toml"));
  EXPECT_THAT(after, HasSubstr("yaw_deg = 40\n"));
  EXPECT_THAT(after, HasSubstr("[glare]\nbloom_strength = 0.25\n"));
  EXPECT_EQ(after.find("ev ="), std::string::npos);
  std::istringstream lines(before);
  for (std::string line; std::getline(lines, line);) EXPECT_THAT(after, HasSubstr(line + "\n")) << "nothing else changed";

  const CommandResult drawn = run_catchlight({"overlay", folder(), "-o", path("drawn.%04d.png")});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.error;
  const cv::Mat seen = cv::imread(path("seen.png")), overlaid = cv::imread(path("drawn.0005.png"));
  ASSERT_EQ(seen.size(), overlaid.size());
  EXPECT_EQ(cv::norm(seen, overlaid, cv::NORM_INF), 0) << "what is seen is what is drawn";
}

/// What ASession... leaves; the place is where the drag took the object.
std::string scene_after_session(const std::string& place_m) {
  return R"(# Suzanne in a courtyard: soft light, one Lambertian object with deep concavities.

[tag]
family = "tag36h11"
id = 0
size_m = 0.08
white_albedo = 0.8
black_albedo = 0.04

[[object]]
mesh = "object.glb"
tag_from_object = { rotation_deg = [90, 0, 12], scale = 1.0, translation_m = )" +
         place_m + R"( }

[receiver]
plane = "tag"
albedo = [0.5, 0.4, 0.3]

[probe]
image = "other.exr"
layout = "latlong"
up = "z"
fixed_to = "tag"
yaw_deg = -30

[exposure]
mode = "fixed"
ev = 0.25

[glare]
enabled = false
bloom_strength = 0.05

[lens]
noise = false
shutter = 1

[quality]
samples = 3
)";
}

/// A session as people have them, with a parameter of each kind, by controls and by keys.
TEST_F(TuneCli, ASessionLeavesExactlyTheExpectedFileAndPicture) {
  std::filesystem::copy_file(kRecordings + "gloss/probe.exr", path("other.exr"));
  const auto control = [](const std::string& key, const std::string& action) {
    return "click search\nkey ctrl+a\ntype " + key + "\n" + action + '\n';
  };
  const CommandResult result = run(
      "wait\ndrag timeline 0.1 0.9\nwait\nseek 7\n"
      "set exposure.ev 0.25\nset glare.bloom_strength 0.05\nset probe.yaw_deg -30\nset receiver.albedo 0.5,0.4,0.3\n" +
      control("lens.shutter", "drag lens.shutter 0.5 1.5") + control("glare.enabled", "click glare.enabled") +
      control("lens.noise", "click lens.noise\nclick lens.noise off") +
      control("exposure.mode", "click exposure.mode\nclick exposure.mode fixed") +
      control("probe.image", "click probe.image\nkey ctrl+a\ntype other.exr\nkey enter") + control("quality.samples", "wait") +
      "set quality.samples 3\nset quality.bands 4\nset glare.threshold 3\nset tag.white_albedo 0.7\n"
      "click undo\nclick undo\nkey ctrl+z\nwait\ndrag picture 0.5 0.55\nwait\npicture " +
      path("seen.png") + "\nsave\nquit\n");
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const std::string after = text_of(path("scene.toml"));
  std::smatch place;
  ASSERT_TRUE(std::regex_search(after, place, std::regex(R"(translation_m = (\[0\.0[0-9]+, -?0\.0[0-9]+, 0\]))"))) << after;
  EXPECT_EQ(after, scene_after_session(place[1]));
  const CommandResult drawn = run_catchlight({"overlay", folder(), "-o", path("drawn.%04d.png")});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.error;
  const cv::Mat seen = cv::imread(path("seen.png")), overlaid = cv::imread(path("drawn.0007.png"));
  ASSERT_EQ(seen.size(), overlaid.size());
  EXPECT_EQ(cv::norm(seen, overlaid, cv::NORM_INF), 0) << "what is seen is what is drawn";
}

TEST_F(TuneCli, ControlsAreClickedAndDragged) {
  const CommandResult result =
      run("click lens\nclick search\ntype glare.bloom\nwait\ndrag glare.bloom_strength 0.2 0.8\nwait\n"
          "click play\nclick play\nkey home\nwait\nexpect frame 0\nkey right\nwait\nexpect frame 1\n"
          "screenshot " +
          path("window.png") + "\nwait\nquit\n");
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const cv::Mat window = cv::imread(path("window.png"));
  EXPECT_EQ(window.size(), cv::Size(1280, 720));
  EXPECT_GT(cv::mean(window)[0], 10);
}

TEST_F(TuneCli, BringsTheFilesValueBack) {
  const CommandResult result =
      run("set probe.yaw_deg 10\nset probe.image /nowhere.exr\nclick probe\nwait\n"
          "click probe.yaw_deg reset\nclick probe.image reset\nwait\n"
          "expect probe.yaw_deg 0\nexpect probe.image probe.exr\nquit\n");
  EXPECT_EQ(result.exit_code, 0) << result.error;
}

TEST_F(TuneCli, SaysWhereAScriptFails) {
  const CommandResult unknown = run("wait\nclik undo\n");
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_THAT(unknown.error, HasSubstr("script.txt:2: unknown command 'clik'; did you mean 'click'?"));
  const CommandResult missing = run("click nothing of that name\n");
  EXPECT_THAT(missing.error, HasSubstr("script.txt:1: there is no control 'nothing of that name'"));
  const CommandResult other = run("expect probe.ev 3\n");
  EXPECT_THAT(other.error, HasSubstr("script.txt:1: probe.ev is 0, expected 3"));
  const CommandResult refused = run("wait\nset exposure.ev hello\n");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.error, HasSubstr("script.txt:2: --exposure.ev is \"hello\"; expected a number from -30 to 30 EV"));
}

TEST_F(TuneCli, ClosesWhileItTracks) {
  const CommandResult result = run("quit\n");
  EXPECT_EQ(result.exit_code, 0) << result.error;
}

TEST_F(TuneCli, ShowsWhatIsWrongAndGoesOn) {
  const CommandResult result = run("set probe.image nowhere.exr\nwait\nclick undo\nwait\npicture " + path("p.png") + "\nquit\n");
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_TRUE(std::filesystem::exists(path("p.png")));
}

TEST(TuneWithoutAScreen, SaysWhatToDo) {
  const CommandResult result = run_catchlight({"tune", kRecordings + "matte"}, {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("no window can be opened"));
  EXPECT_THAT(result.error, HasSubstr("--screenshot"));
}

TEST(TuneWithoutARecording, ShowsAnEmptyWindow) {
  const TemporaryFolder folder;
  const CommandResult result = run_catchlight({"tune", "--frames", "3", "--screenshot", folder.path("empty.png")});
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_FALSE(cv::imread(folder.path("empty.png")).empty());
}

}  // namespace
}  // namespace catchlight::tests
