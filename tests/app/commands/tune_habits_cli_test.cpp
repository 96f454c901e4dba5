// What the window begins with, and what it remembers.
#include <gmock/gmock.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "tests/support/run_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::tests {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kRecordings = std::string(CATCHLIGHT_SOURCE_DIR) + "/recordings/";

class TuneHabits : public ::testing::Test {
 protected:
  CommandResult run(const std::string& script, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"tune", "--headless", "--ui-script", folder_.write("script.txt", script)});
    return run_catchlight(more, {{"XDG_STATE_HOME", folder_.path("state")}});
  }
  std::string state() const { return read_text(folder_.path("state/catchlight/tune.toml")); }

  TemporaryFolder folder_;
};

TEST_F(TuneHabits, BeginsWithExamplesAndTheLastRecordings) {
  const CommandResult first = run("click example mirror\nexpect error none\nexpect frame 0\nquit\n");
  ASSERT_EQ(first.exit_code, 0) << first.error;
  EXPECT_THAT(state(), HasSubstr("recordings/mirror"));
  const CommandResult again = run("click recent 1\nexpect error none\nexpect probe.image probe.exr\nquit\n");
  EXPECT_EQ(again.exit_code, 0) << again.error;
}

TEST_F(TuneHabits, RemembersSizeSidePanelAndOpenSections) {
  const CommandResult first = run("click glare\ndrag side-edge 0 -20\nquit\n", {kRecordings + "matte", "--size", "1400x800"});
  ASSERT_EQ(first.exit_code, 0) << first.error;
  EXPECT_THAT(state(), HasSubstr("width = 1400"));
  const std::string window = folder_.path("window.png");
  const CommandResult again = run("drag glare.bloom_strength 0.2 0.8\nquit\n", {kRecordings + "matte", "--screenshot", window});
  EXPECT_EQ(again.exit_code, 0) << again.error << "the section was open";
  EXPECT_EQ(cv::imread(window).size(), cv::Size(1400, 800));
}

TEST_F(TuneHabits, SaysSoWhereTheFileIsDamagedAndMakesItAnew) {
  folder_.write("state/catchlight/tune.toml", "= nonsense");
  const CommandResult result = run("quit\n");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.error, HasSubstr("tune.toml: damaged, and made anew"));
  EXPECT_THAT(state(), HasSubstr("width = 1280"));
}

TEST(TuneWithoutAPerson, LeavesNoTraceUnlessAskedTo) {
  const TemporaryFolder home;
  const CommandResult result = run_catchlight(
      {"tune", "--frames", "2"}, {{"XDG_STATE_HOME", ""}, {"XDG_CACHE_HOME", home.path("cache")}, {"HOME", home.path()}});
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_FALSE(std::filesystem::exists(home.path(".local/state")));
}

TEST_F(TuneHabits, DrawsMorePixelsAUnitWhereTheDisplayHasThem) {
  const std::string window = folder_.path("window.png");
  const CommandResult result = run("wait\nquit\n", {"--size", "1024x640", "--scale", "2", "--screenshot", window});
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_EQ(cv::imread(window).size(), cv::Size(2048, 1280));
}

/// A small window has room for all of its buttons.
TEST_F(TuneHabits, CutsNothingOffInASmallWindow) {
  for (const char* size : {"1024x640", "700x480"}) {
    const CommandResult result =
        run("expect frame 0\nclick play\nclick play\nclick mark end\nclick clear marks\nclick keep B\nclick ?\nquit\n",
            {kRecordings + "matte", "--size", size});
    EXPECT_EQ(result.exit_code, 0) << size << result.error;
  }
}

}  // namespace
}  // namespace catchlight::tests
