// README's section on one's own footage, line by line, in a folder made for it: what it says can be typed.
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/run_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::tests {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

/// From the section's heading to the next.
std::string section(const std::string& heading) {
  const std::string readme = read_text(CATCHLIGHT_SOURCE_DIR "/README.md");
  const std::size_t begin = readme.find("\n## " + heading + "\n");
  if (begin == std::string::npos) ADD_FAILURE() << "README has no section \"" << heading << "\"";
  return readme.substr(begin, readme.find("\n## ", begin + 1) - begin);
}

/// The first group of all matches.
std::vector<std::string> all_of(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match) found.push_back((*match)[1]);
  return found;
}

/// The contents of the fenced blocks of a language ("" for none).
std::vector<std::string> blocks(const std::string& text, const std::string& language) {
  std::vector<std::string> found;
  std::istringstream lines(text);
  std::optional<std::string> open;  // the language of the block that is being read
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      open = open ? std::nullopt : std::optional(line.substr(3));
      if (open == language) found.emplace_back();
    } else if (open == language) {
      found.back() += line + "\n";
    }
  }
  return found;
}

class ReadmeCommand : public ::testing::Test {
 protected:
  /// The section's folder of a shot. Its footage, camera, probe and model are those of a shipped recording, whose tag is the one
  /// that the section's scene names; the footage is twelve frames long.
  void SetUp() override {
    ASSERT_THAT(blocks(text_, "toml"), SizeIs(1));
    folder_.write("my-shot/scene.toml", blocks(text_, "toml")[0]);
    const std::string matte = CATCHLIGHT_SOURCE_DIR "/recordings/matte/";
    fs::copy(matte + "camera.yaml", folder_.path("my-shot/camera.yaml"));
    fs::copy(matte + "probe.exr", folder_.path("my-shot/probe.exr"));
    fs::copy(matte + "object.glb", folder_.path("my-shot/robot.glb"));
    expect_typed("ffmpeg -v error -nostdin -i " + matte + "video.mp4 -frames:v 12 -c copy my-shot/video.mp4");
  }

  CommandResult type(const std::string& line) {
    const std::string path = fs::path(CATCHLIGHT_BINARY_DIR) / "app";
    return run_program("/bin/bash", {"-c", "set -o pipefail; cd " + folder_.path() + "; " + line},
                       {{"PATH", path + ":" + std::getenv("PATH")}, {"XDG_CACHE_HOME", folder_.path("cache")}});
  }

  void expect_typed(const std::string& line) {
    const CommandResult result = type(line);
    EXPECT_EQ(result.exit_code, 0) << line << "\n" << result.error;
  }

  std::size_t files_named(const std::string& pattern) const {
    std::size_t count = 0;
    for (const std::string& name : folder_.names()) count += std::regex_match(name, std::regex(pattern)) ? 1 : 0;
    return count;
  }

  const std::string text_ = section("Your own footage");
  TemporaryFolder folder_;
};

TEST_F(ReadmeCommand, TheFolderHasEveryFileThatItIsSaidToHave) {
  const std::string listing = blocks(text_, "")[0];
  const std::vector<std::string> names = all_of(listing, std::regex("\\n  (\\S+\\.\\w+)")),
                                 beside = all_of(listing, std::regex("\\n  \\S+\\.\\w+  ?(\\w+\\.\\w+)\\n"));
  EXPECT_THAT(names, ElementsAre("video.mp4", "camera.yaml", "scene.toml", "probe.exr"));
  EXPECT_THAT(beside, ElementsAre("robot.glb"));
}

TEST_F(ReadmeCommand, TheTagIsPrinted) {
  const std::vector<std::string> lines = all_of(text_.substr(0, text_.find("```")), std::regex("`(catchlight [^`]*)`"));
  EXPECT_THAT(lines, Not(IsEmpty()));
  for (const std::string& line : lines) expect_typed(line);
  EXPECT_TRUE(fs::exists(folder_.path("tag.pdf")));
}

/// One line after the other, as somebody types them who wants to see what each does.
TEST_F(ReadmeCommand, EveryLineOfTheExampleRuns) {
  // What the lines on bare footage take, besides the folder.
  fs::create_directories(folder_.path("plates"));
  expect_typed("ffmpeg -v error -nostdin -i my-shot/video.mp4 -frames:v 2 plates/shot.%04d.png");
  for (const char* name : {"scene.toml", "camera.yaml", "probe.exr", "robot.glb"})
    fs::copy(folder_.path("my-shot/") + name, folder_.path(name));
  const std::string footage = read_text(folder_.path("my-shot/video.mp4"));
  const std::vector<std::string> examples = blocks(text_, "");
  ASSERT_THAT(examples, SizeIs(2)) << "the folder, and the commands";
  const std::vector<std::string> lines = all_of(examples[1], std::regex("([^\\n]+)\\n"));
  EXPECT_THAT(lines, Not(IsEmpty()));
  for (const std::string& line : lines) {
    const std::vector<std::string> before = folder_.names();
    expect_typed(line);
    EXPECT_THAT(folder_.names(), Not(SizeIs(before.size()))) << "nothing new after: " << line;
  }
  EXPECT_EQ(files_named("comp\\.00(10|11)\\.exr"), 2) << "the twelve frames' last two are in 10:50";
  EXPECT_EQ(read_text(folder_.path("my-shot/video.mp4")), footage);
}

TEST_F(ReadmeCommand, WhatTheFolderMayHaveInsteadDoesToo) {
  EXPECT_THAT(text_, HasSubstr("or plate/%04d.png"));
  EXPECT_THAT(text_, HasSubstr("or give --fov 60"));
  fs::create_directories(folder_.path("my-shot/plate"));
  expect_typed("ffmpeg -v error -nostdin -i my-shot/video.mp4 -frames:v 2 my-shot/plate/%04d.png");
  for (const char* name : {"video.mp4", "camera.yaml"}) fs::remove(folder_.path("my-shot/") + name);
  expect_typed("catchlight overlay my-shot -o comp.mp4 --fov 60");
}

}  // namespace
}  // namespace catchlight::tests
