#include "app/window/editing/overlay_command.hpp"

#include <gmock/gmock.h>

#include "app/settings/parameters.hpp"

namespace catchlight::app {
namespace {

using ::testing::ElementsAre;

TEST(OverlayArguments, AreTheRecordingWhereNothingWasTurned) {
  const SceneSettings file;
  EXPECT_THAT(overlay_arguments("shot", {}, file, file, {}, "a.mp4"), ElementsAre("overlay", "shot", "-o", "a.mp4"));
}

TEST(OverlayArguments, HoldWhatWasTurnedAndTheRange) {
  SceneSettings file, now;
  RecordingOverrides overrides;
  overrides.fov_deg = 60;
  for (SceneSettings* settings : {&file, &now}) settings->objects.resize(2);
  set_parameter_from_text(now, "probe.yaw_deg", "40");
  set_parameter_from_text(now, "object[1].tag_from_object.scale", "2");
  EXPECT_THAT(overlay_arguments("shot", overrides, file, now, {3, 9}, "a.mp4"),
              ElementsAre("overlay", "shot", "-o", "a.mp4", "--fov", "60", "--object[1].tag_from_object.scale", "2",
                          "--probe.yaw_deg", "40", "--frames", "3:9"));
}

TEST(OverlayArguments, TurningBackWhatTheCommandLineSaidCounts) {
  RecordingOverrides overrides;
  overrides.parameters = {{"probe.ev", "1"}};
  SceneSettings file;
  set_parameter_from_text(file, "probe.ev", "1");
  SceneSettings now = file;
  EXPECT_THAT(overlay_arguments("s", overrides, file, now, {}, "a.mp4"),
              ElementsAre("overlay", "s", "-o", "a.mp4", "--probe.ev", "1"));
  set_parameter_from_text(now, "probe.ev", "0.5");
  EXPECT_THAT(overlay_arguments("s", overrides, file, now, {}, "a.mp4"),
              ElementsAre("overlay", "s", "-o", "a.mp4", "--probe.ev", "0.5"));
}

TEST(ShellText, QuotesWhatAShellWouldTakeApart) {
  EXPECT_EQ(shell_text({"catchlight", "a b", "it's", "", "x=1,2"}), "catchlight 'a b' 'it'\\''s' '' x=1,2");
  EXPECT_EQ(shell_text({"object[1].mesh"}), "'object[1].mesh'") << "brackets match files";
}

}  // namespace
}  // namespace catchlight::app
