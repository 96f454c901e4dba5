// replay --renderer both: the processor's pictures against OpenGL's, frame by frame.
#include <gmock/gmock.h>

#include "tests/app/commands/overlay_command.hpp"

namespace catchlight::tests {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

/// Three frames of a shipped recording with its poses; bakes little.
class ReplayOfBothRenderers : public OverlayCommand {
 protected:
  void SetUp() override { fs::copy(recording() + "/poses.csv", copy_ + "/poses.csv"); }

  CommandResult replay(std::vector<std::string> more) {
    std::vector<std::string> arguments = {"replay",           copy_, "-o", folder_.path("sheets"), "--bless", "--quality.rays=64",
                                          "--quality.bands=2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_catchlight(arguments, {{"XDG_CACHE_HOME", folder_.path("cache")}});
  }

  const std::string copy_ = copied_recording(3);
};

TEST_F(ReplayOfBothRenderers, SaysHowFarTheyAreApart) {
  const CommandResult both = replay({"--renderer", "both"});
  EXPECT_EQ(both.exit_code, 0) << both.error;
  EXPECT_THAT(both.output, HasSubstr("recording  cpu and gl differ by at most 0."));
  EXPECT_THAT(both.output, HasSubstr("in 3 frames"));
  for (const char* one : {"cpu", "gl"}) {
    const CommandResult alone = replay({"--renderer", one});
    EXPECT_EQ(alone.exit_code, 0) << alone.error;
    EXPECT_THAT(alone.output, Not(HasSubstr("cpu and gl")));
  }
}

/// The first frames of each recording as users draw it, but for the bake, which both renderers share.
TEST(ReplayOfBothRenderersInEveryRecording, IsOnePicture) {
  for (const std::string name : {"matte", "mirror", "gloss", "dazzle", "frontal"}) {
    SCOPED_TRACE(name);
    const TemporaryFolder folder;
    const std::string copy = folder.path(name);
    fs::create_directories(copy);
    for (const fs::directory_entry& file : fs::directory_iterator(recording(name)))
      if (file.is_regular_file() && file.path().filename() != "video.mp4") fs::copy(file, copy);
    if (name == "frontal") fs::create_directory_symlink(recording("matte"), folder.path("matte"));
    run_shell("ffmpeg -v error -nostdin -i " + recording(name) + "/video.mp4 -frames:v 2 -c copy " + copy + "/video.mp4");
    const CommandResult both =
        run_catchlight({"replay", copy, "-o", folder.path("sheets"), "--renderer", "both", "--bless", "--quality.rays=64"},
                       {{"XDG_CACHE_HOME", folder.path("cache")}});
    EXPECT_EQ(both.exit_code, 0) << both.error;
    EXPECT_THAT(both.output, HasSubstr("in 2 frames"));
  }
}

TEST_F(ReplayOfBothRenderers, FailsWhereTheyDrawDifferentPicturesWhateverIsBlessed) {
  const std::string shaders = folder_.path("shaders");
  fs::copy(CATCHLIGHT_SOURCE_DIR "/shaders", shaders);
  replace_in(shaders + "/composite.frag", "vec4(new_code, changed", "vec4(new_code + 0.03, changed");
  const CommandResult both = replay({"--renderer", "both", "--shader-dir", shaders});
  EXPECT_EQ(both.exit_code, 1);
  EXPECT_THAT(both.error, HasSubstr("recording: cpu and gl differ in frame"));
  EXPECT_THAT(both.error, HasSubstr("99th percentile 7."));
  EXPECT_THAT(both.error, HasSubstr("of 255, expected at most 2.0"));
}

TEST_F(ReplayOfBothRenderers, IsAChoiceOfReplayAlone) {
  const CommandResult overlaid = overlay(copy_, out_, {"--renderer", "both"});
  EXPECT_EQ(overlaid.exit_code, 2);
  EXPECT_THAT(overlaid.error, HasSubstr("both"));
}

}  // namespace
}  // namespace catchlight::tests
