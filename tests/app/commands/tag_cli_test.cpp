// tag as users run it.
#include <gmock/gmock.h>

#include "tests/support/run_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::tests {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr int kFailure = 1, kUsage = 2;

CommandResult tag(const std::string& output, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{"tag", "-o", output};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_catchlight(arguments);
}

TEST(TagCommand, WritesEachFormatAndTheSceneOnStdout) {
  const TemporaryFolder folder;
  for (const auto& [name, signature] :
       {std::pair("t.pdf", "%PDF-1.4"), std::pair("t.svg", "<svg "), std::pair("t.png", "\x89PNG")}) {
    const CommandResult result = tag(folder.path(name), {"--id", "3", "--size-m", "0.08"});
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.output, "[tag]\nfamily = \"tag36h11\"\nid = 3\nsize_m = 0.08\n");
    EXPECT_THAT(result.error, HasSubstr("size_m = 0.08; print at 100 %"));
    EXPECT_THAT(read_text(folder.path(name)), StartsWith(signature));
  }
  EXPECT_THAT(folder.names(), ElementsAre("t.pdf", "t.png", "t.svg"));
}

TEST(TagCommand, PngTellsTheSizesThatItsPixelsAllow) {
  const TemporaryFolder folder;
  const CommandResult result =
      tag(folder.path("t.png"), {"--board", "2x1", "--size-m", "0.04", "--spacing-m", "0.05123", "--dpi", "100"});
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_THAT(result.error, HasSubstr("each cell is 20 pixels; print at 101.6 dpi"));
  EXPECT_THAT(result.output, HasSubstr("translation_m = [0.05125, 0, 0]"));  // 205 pixels at 4000/m
}

TEST(TagCommand, TheSameCommandWritesTheSameBytes) {
  const TemporaryFolder folder;
  for (const char* name : {"t.pdf", "t.svg", "t.png"}) {
    tag(folder.path(name), {"--size-m", "0.05"});
    const std::string first = read_text(folder.path(name));
    EXPECT_EQ(tag(folder.path(name), {"--size-m", "0.05", "-y"}).exit_code, 0);
    EXPECT_TRUE(read_text(folder.path(name)) == first) << name;
  }
}

TEST(TagCommand, ExistingOutputIsKeptUnlessAllowed) {
  const TemporaryFolder folder;
  const std::string out = folder.write("t.pdf", "mine");
  const CommandResult result = tag(out);
  EXPECT_EQ(result.exit_code, kUsage);
  EXPECT_THAT(result.error, HasSubstr(out + ": exists already; pass -y"));
  EXPECT_EQ(read_text(out), "mine");
}

TEST(TagCommand, BadCommandLinesNameTheOptionAndLeaveNothing) {
  const TemporaryFolder folder;
  const std::string pdf = folder.path("t.pdf");
  const auto refused = [&](const std::string& out, std::vector<std::string> options, const std::string& message,
                           int exit_code = kUsage) {
    const CommandResult result = tag(out, std::move(options));
    EXPECT_EQ(result.exit_code, exit_code) << message;
    EXPECT_EQ(result.output, "");
    EXPECT_THAT(result.error, AllOf(StartsWith("catchlight: error: "), HasSubstr(message)));
    EXPECT_THAT(folder.names(), ElementsAre());
  };
  refused(folder.path("t.jpg"), {}, "t.jpg: expected a name that ends in .pdf, .svg or .png");
  refused(pdf, {"--id", "9999"}, "tag id 9999 does not exist in tag36h11", kFailure);
  refused(pdf, {"--family", "tag1h1"}, "tag family 'tag1h1' is not known", kFailure);
  refused(pdf, {"--id", "1", "--ids", "0:3"}, "--ids");
  refused(pdf, {"--ids", "3:3"}, "--ids is 3:3; expected A:B");
  refused(pdf, {"--ids", "0:99999999999"}, "--ids is 0:99999999999; expected A:B");
  refused(folder.path("t.svg"), {"--ids", "0:3"}, "holds one page");
  refused(pdf, {"--board", "4by3"}, "--board is 4by3; expected columns x rows");
  refused(pdf, {"--board", "4x3"}, "--board needs --spacing-m");
  refused(pdf, {"--board", "2x2", "--ids", "0:3", "--spacing-m", "0.1"}, "--ids 0:3 are 3 tags, but --board 2x2 has room for 4");
  refused(pdf, {"--size-m", "-0.08"}, "--size-m is -0.08; expected metres");
  refused(pdf, {"--paper", "a9"}, "--paper is \"a9\"; expected");
  refused(folder.path("no/t.pdf"), {}, "there is no folder", kFailure);
}

}  // namespace
}  // namespace catchlight::tests
