// The hands on the picture and on the light, by scripts.
#include <gmock/gmock.h>

#include <cstdio>
#include <opencv2/imgcodecs.hpp>

#include "tests/app/commands/tuned_recording.hpp"

namespace catchlight::tests {
namespace {

using ::testing::HasSubstr;
using TuneHands = TunedRecording;

/// Quick to bake: these tests are not about its light.
const std::string kQuick = "set quality.rays 64\nset quality.bands 3\nset quality.bounces 0\n";

TEST_F(TuneHands, ADragAcrossTheBallTurnsTheProbeAndIsOneStep) {
  const CommandResult result = run(kQuick +
                                   "click light\nwait\ndrag probe ball 0.5 0.75\nwait\nsave\nclick undo\n"
                                   "expect probe.yaw_deg 0\nexpect quality.bounces 0\nclick redo\nquit\n");
  ASSERT_EQ(result.exit_code, 0) << result.error;
  double yaw_deg = 0;
  const std::string scene = text_of(path("scene.toml"));
  ASSERT_EQ(std::sscanf(scene.substr(scene.find("yaw_deg")).c_str(), "yaw_deg = %lf", &yaw_deg), 1) << scene;
  EXPECT_NEAR(yaw_deg, 57.3, 1.5) << "half a radius, twice as far: a radian";
}

TEST_F(TuneHands, TheShadowTurnsTheProbeWithoutMovingTheObject) {
  const CommandResult result =
      run(kQuick +
          "wait\nhold l\ndrag 500 400 600 300\nrelease\nexpect object.tag_from_object.translation_m 0,0,0\n"
          "save\nclick undo\nexpect probe.yaw_deg 0\nquit\n");
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(text_of(path("scene.toml")), HasSubstr("yaw_deg = "));
}

/// The tag lies on that paper, and `match` reads the balance off the tag.
TEST_F(TuneHands, PaperBesideTheTagNeedsNoBalanceButThatOfTheTag) {
  const CommandResult result = run(kQuick + "wait\nkey w\ndrag 570 385 570 385\nsave\nwait\npicture " + path("seen.png") +
                                   "\nclick undo\nexpect exposure.white_balance 1,1,1\nquit\n");
  ASSERT_EQ(result.exit_code, 0) << result.error;
  const std::string scene = text_of(path("scene.toml"));
  double red = 0, green = 0, blue = 0;
  ASSERT_EQ(
      std::sscanf(scene.substr(scene.find("white_balance")).c_str(), "white_balance = [%lf, %lf, %lf]", &red, &green, &blue), 3)
      << scene;
  for (const double gain : {red, green, blue}) EXPECT_NEAR(gain, 1, 0.06);
  const CommandResult drawn = run_catchlight({"overlay", folder(), "-o", path("drawn.%04d.png")});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.error;
  EXPECT_EQ(cv::norm(cv::imread(path("seen.png")), cv::imread(path("drawn.0000.png")), cv::NORM_INF), 0);
}

TEST_F(TuneHands, WhatTellsNoColourSetsNoBalance) {
  const CommandResult result = run(kQuick +
                                   "set exposure.mode fixed\nwait\nkey w\nkey escape\ndrag 570 385 570 385\n"
                                   "expect exposure.white_balance 1,1,1\nquit\n");
  EXPECT_EQ(result.exit_code, 0) << result.error;
}

TEST_F(TuneHands, EffectsGoOffAndComeBackAsTheFileHasThem) {
  const std::string before = text_of(path("scene.toml"));
  const CommandResult result =
      run("wait\nclick effects\nclick effect noise\nexpect lens.noise false\nclick effect receiver\nexpect receiver.plane none\n"
          "click effect glare\nexpect glare.enabled false\nclick undo\nexpect glare.enabled true\n"
          "click effect noise\nexpect lens.noise auto\nclick effect receiver\nexpect receiver.plane tag\n"
          "save\nquit\n");
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_EQ(text_of(path("scene.toml")), before);
}

TEST_F(TuneHands, SavesUnderAnotherNameAndGoesOnThere) {
  const std::string before = text_of(path("scene.toml"));
  const CommandResult result = run("set exposure.ev 1\nclick save as\nclick write\nset exposure.ev 2\nsave\nquit\n");
  ASSERT_EQ(result.exit_code, 0) << result.error;
  EXPECT_EQ(text_of(path("scene.toml")), before);
  EXPECT_THAT(text_of(path("scene-2.toml")), HasSubstr("ev = 2\n"));
}

TEST_F(TuneHands, ReplacesAFileOnlyWhereThatIsSaid) {
  folder_.write("scene-2.toml", "# mine\n");
  const CommandResult refused = run("set exposure.ev 1\nclick save as\nclick write\n");
  EXPECT_THAT(refused.error, HasSubstr("there is no control 'write'"));
  EXPECT_EQ(text_of(path("scene-2.toml")), "# mine\n");
  ASSERT_EQ(run("set exposure.ev 1\nclick save as\nclick replace\nquit\n").exit_code, 0);
  EXPECT_THAT(text_of(path("scene-2.toml")), HasSubstr("ev = 1\n"));
}

}  // namespace
}  // namespace catchlight::tests
