// Footage from a pipe, and tracks into one.
#include <gmock/gmock.h>

#include <cstdlib>
#include <sstream>

#include "tests/support/run_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight::tests {
namespace {

using ::testing::HasSubstr;

const std::string kRecording = CATCHLIGHT_SOURCE_DIR "/recordings/matte";
constexpr int kFrames = 8;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

class Pipe : public ::testing::Test {
 protected:
  /// `track -` whose stdin is what `producer` (the shell's) writes; the frames are in all.y4m.
  CommandResult track_piped(const std::string& producer, const std::string& output) {
    const std::string all = folder_.path("all.y4m");
    const std::string make =
        "ffmpeg -v error -nostdin -y -i " + kRecording + "/video.mp4 -frames:v " + std::to_string(kFrames) + " " + all;
    EXPECT_EQ(std::system(make.c_str()), 0);
    const std::string command = "cd " + folder_.path("") + " && (" + producer +
                                ") | " CATCHLIGHT_BINARY_DIR "/app/catchlight track - -o " + output + " --scene " + kRecording +
                                "/scene.toml --camera " + kRecording + "/camera.yaml";
    return run_program("/bin/sh", {"-c", command}, {});
  }

  TemporaryFolder folder_;
};

TEST_F(Pipe, EveryFrameOfAPipeIsTrackedAndTheTrackGoesToStdout) {
  const CommandResult result = track_piped("cat all.y4m", "-");
  EXPECT_EQ(result.exit_code, 0) << result.error;
  const std::vector<std::string> lines = lines_of(result.output);
  ASSERT_EQ(lines.size(), 1u + kFrames);
  EXPECT_THAT(lines[0], HasSubstr("frame,time_s,found"));
  for (int i = 0; i < kFrames; ++i) EXPECT_EQ(lines[static_cast<std::size_t>(1 + i)].substr(0, 2), std::to_string(i) + ",");
}

/// The second half of the footage comes only when the lines of the first are there.
TEST_F(Pipe, LinesAreThereAsSoonAsTheirFramesAreTracked) {
  const std::string producer =
      "size=$(stat -c %s all.y4m); head -c $((size / 2 + 100)) all.y4m; "
      "for i in $(seq 600); do [ $(cat track.jsonl 2>/dev/null | wc -l) -ge 3 ] && break; sleep 0.1; done; "
      "wc -l < track.jsonl > seen; tail -c +$((size / 2 + 101)) all.y4m";
  const CommandResult result = track_piped(producer, "track.jsonl");
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_GE(std::stoi(read_text(folder_.path("seen"))), 3);
  EXPECT_EQ(lines_of(read_text(folder_.path("track.jsonl"))).size(), static_cast<std::size_t>(kFrames));
}

TEST_F(Pipe, SaysWhatItWaitsFor) {
  const CommandResult result = track_piped("sleep 3; cat all.y4m", "-");
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_EQ(count_of("waiting for stdin\n", result.error), 1) << result.error;
}

TEST_F(Pipe, AnEmptyPipeIsAnError) {
  const CommandResult result = track_piped("true", "-");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("catchlight: error: "));
  EXPECT_EQ(result.output, "");
}

}  // namespace
}  // namespace catchlight::tests
