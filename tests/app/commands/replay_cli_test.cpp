// replay as users run it: against truth, and against a run that was kept.
#include <gmock/gmock.h>

#include "tests/app/commands/overlay_command.hpp"

namespace catchlight::tests {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

using ReplayCommand = OverlayCommand;

TEST_F(ReplayCommand, WithoutExpectedFiguresFailsAndBlessWritesThem) {
  const std::string copy = copied_recording(1);
  fs::copy(recording() + "/poses.csv", copy + "/poses.csv");
  for (const char* kind : {"truth", "mask", "plate_clean"}) {
    fs::create_directories(copy + "/" + kind);
    fs::copy(recording() + "/" + kind + "/0000.png", copy + "/" + kind + "/0000.png");
  }
  const auto replay = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"replay",
                                          copy,
                                          "-o",
                                          folder_.path("sheets"),
                                          "--quiet",
                                          "--quality.rays=64",
                                          "--quality.bands=2",
                                          "--quality.reflection_rays=0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_catchlight(arguments, {{"XDG_CACHE_HOME", folder_.path("cache")}});
  };
  const CommandResult missing = replay({});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.error, HasSubstr("--bless"));
  EXPECT_TRUE(fs::exists(folder_.path("sheets/recording.png")));
  EXPECT_EQ(replay({"--bless"}).exit_code, 0);
  EXPECT_EQ(replay({}).exit_code, 0) << "nothing drifts between two runs";
  const CommandResult drifted = replay({"--exposure.ev", "0.5"});
  EXPECT_EQ(drifted.exit_code, 1);
  EXPECT_THAT(drifted.error, HasSubstr("mask.mean"));
}

TEST_F(ReplayCommand, HoldsARecordingWithoutTruthAgainstARunOfItsOwn) {
  const std::string copy = copied_recording(3), report = folder_.path("report.json");
  const auto replay = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"replay", copy, "-o", folder_.path("sheets"), "--renderer", "cpu", "--quality.rays=64",
                               "--quality.bands=2", "--quality.reflection_rays=0"});
    return run_catchlight(more, {{"XDG_CACHE_HOME", folder_.path("cache")}});
  };
  const CommandResult nothing = replay({});
  EXPECT_EQ(nothing.exit_code, 1);
  EXPECT_THAT(nothing.error, AllOf(HasSubstr("--bless"), Not(HasSubstr("frames")))) << "said before the footage is tracked";
  EXPECT_EQ(replay({"--bless"}).exit_code, 0);
  for (const char* kept : {"track.csv", "0000.png", "0001.png", "0002.png"}) EXPECT_TRUE(fs::exists(copy + "/baseline/" + kept));
  const CommandResult again = replay({"--report", report});
  EXPECT_EQ(again.exit_code, 0) << again.error;
  EXPECT_THAT(again.output, HasSubstr("differs from its baseline by at most 0.00 (mean) and 0 (99th percentile)"));
  EXPECT_THAT(read_text(report), HasSubstr("\"as_expected\": true"));
  EXPECT_EQ(replay({"--report", report}).exit_code, 2) << "an existing report stays";
  const CommandResult drifted = replay({"--exposure.ev", "0.2", "--report", report, "-y"});
  EXPECT_EQ(drifted.exit_code, 1);
  EXPECT_THAT(drifted.error, HasSubstr("picture.mean"));
  EXPECT_THAT(read_text(report), HasSubstr("\"as_expected\": false"));
}

TEST_F(ReplayCommand, SaysWhereThereIsNoSheet) {
  const std::string copy = copied_recording(2);
  fs::copy(recording() + "/poses.csv", copy + "/poses.csv");
  const CommandResult result = run_catchlight({"replay", copy, "-o", folder_.path("sheets"), "--bless"});
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.output, AllOf(HasSubstr("No sheet of recording"), Not(HasSubstr("Sheets plate"))));
}

}  // namespace
}  // namespace catchlight::tests
