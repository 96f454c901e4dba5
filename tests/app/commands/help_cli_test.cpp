// What the program says of itself: help, and how it is asked for.
#include <gmock/gmock.h>

#include <algorithm>

#include "catchlight/util/text.hpp"
#include "tests/support/run_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::tests {
namespace {

using ::testing::HasSubstr;

constexpr int kFailure = 1, kUsage = 2;

/// As help is asked for, but on stderr and with an exit code: a script that forgot the command has to notice.
TEST(Help, WithoutCommandShowsHelp) {
  const CommandResult bare = run_catchlight({}), probe = run_catchlight({"probe"});
  for (const CommandResult& result : {bare, probe}) {
    EXPECT_EQ(result.exit_code, kUsage);
    EXPECT_EQ(result.output, "");
  }
  EXPECT_EQ(bare.error, run_catchlight({"--help"}).output);
  EXPECT_EQ(probe.error, run_catchlight({"probe", "--help"}).output);
}

TEST(Help, HelpIsACommandToo) {
  EXPECT_EQ(run_catchlight({"help"}).output, run_catchlight({"--help"}).output);
  EXPECT_EQ(run_catchlight({"help", "probe", "merge"}).output, run_catchlight({"probe", "merge", "--help"}).output);
  const CommandResult mistyped = run_catchlight({"help", "overly"});
  EXPECT_EQ(mistyped.exit_code, kUsage);
  EXPECT_THAT(mistyped.error, HasSubstr("unknown command 'overly'; did you mean 'overlay'?"));
}

const std::vector<std::vector<std::string>> kAllCommands{{"overlay"},          {"track"},         {"replay"},
                                                         {"reference"},        {"bake"},          {"probe"},
                                                         {"probe", "merge"},   {"probe", "info"}, {"probe", "split"},
                                                         {"probe", "convert"}, {"probe", "sh"},   {"probe", "ball"},
                                                         {"probe", "preview"}, {"glare"},         {"tag"},
                                                         {"calibrate"},        {"info"},          {"params"}};

/// The command lines under "Examples:".
std::vector<std::string> examples_in(const std::string& help) {
  std::vector<std::string> examples;
  for (const std::string& line : split(help.substr(std::min(help.find("Examples:\n"), help.size())), '\n'))
    if (line.starts_with("  catchlight ")) examples.push_back(line.substr(13));
  return examples;
}

/// Run where none of their files are: a wrong option would be a usage error before those are missed.
TEST(Help, HelpOfEveryCommandHasTwoExamplesThatCanBeTyped) {
  const TemporaryFolder folder;
  for (std::vector<std::string> command : kAllCommands) {
    command.push_back("--help");
    const std::vector<std::string> examples = examples_in(run_catchlight(command).output);
    EXPECT_GE(examples.size(), 2U) << command.front();
    for (const std::string& example : examples) {
      const std::string line = "cd '" + folder.path("") + "' && exec '" CATCHLIGHT_EXECUTABLE "' " + example;
      const CommandResult result = run_program("/bin/sh", {"-c", line}, {});
      EXPECT_TRUE(result.exit_code == 0 || result.exit_code == kFailure) << example << '\n' << result.error;
    }
  }
}

TEST(Help, HelpOfAParameterSaysWhatIsExpectedAndTheDefault) {
  const std::string help = run_catchlight({"overlay", "--help"}).output;
  EXPECT_THAT(help, HasSubstr("[a number from 0.0001 to 0.5; default 0.004]"));
  EXPECT_THAT(help, HasSubstr("[\"direct\", \"corners\" or \"none\"; default direct]"));
  for (const std::string& line : split(help, '\n')) EXPECT_TRUE(line.size() <= 100 || !line.starts_with(' ')) << line;
}

/// It is taken all the same: one set of options fits all commands.
TEST(Help, HelpLeavesOutWhatACommandCannotUse) {
  const auto shows = [](const char* command, const std::string& option) {
    return run_catchlight({command, "--help"}).output.find("--" + option + ' ') != std::string::npos;
  };
  EXPECT_TRUE(shows("track", "tag.id") && shows("track", "exposure.response"));
  EXPECT_FALSE(shows("track", "glare.enabled") || shows("track", "lens.noise") || shows("track", "quality.bands"));
  EXPECT_TRUE(shows("bake", "quality.bands") && shows("bake", "object.mesh"));
  EXPECT_FALSE(shows("bake", "tag.id") || shows("bake", "lens.noise") || shows("bake", "glare.enabled"));
  EXPECT_TRUE(shows("reference", "tag.id") && shows("reference", "probe.image"));
  EXPECT_FALSE(shows("reference", "glare.enabled"));
  EXPECT_TRUE(shows("overlay", "tag.id") && shows("overlay", "glare.enabled"));
  const CommandResult taken = run_catchlight({"track", "/nowhere", "-o", "t.csv", "--glare.enabled", "false"});
  EXPECT_THAT(taken.error, HasSubstr("/nowhere: no such file or folder"));
}

}  // namespace
}  // namespace catchlight::tests
