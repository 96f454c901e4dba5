// `catchlight track` as users run it: solved as a whole, or causally; whole footage, or damaged.
#include <gmock/gmock.h>

#include <cstdlib>

#include "catchlight/track.hpp"
#include "tests/support/pose_error.hpp"
#include "tests/support/run_command.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tracking/track_file.hpp"

namespace catchlight::tests {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const std::string kRecording = CATCHLIGHT_SOURCE_DIR "/recordings/matte";

class TrackCommand : public ::testing::Test {
 protected:
  /// The first frames of a shipped recording, as a Matroska file: it can be read as far as it goes.
  std::string footage(int frames) {
    const std::string file = folder_.path("video.mkv");
    const std::string command =
        "ffmpeg -v error -nostdin -y -i " + kRecording + "/video.mp4 -frames:v " + std::to_string(frames) + " -c copy " + file;
    EXPECT_EQ(std::system(command.c_str()), 0);
    return file;
  }

  CommandResult track(const std::string& footage, const std::string& output, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {
        "track", footage, "-o", output, "--scene", kRecording + "/scene.toml", "--camera", kRecording + "/camera.yaml"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_catchlight(arguments);
  }

  std::vector<TrackRow> tracked(const std::string& footage, const std::string& name, std::vector<std::string> more = {}) {
    const CommandResult result = track(footage, folder_.path(name), std::move(more));
    EXPECT_EQ(result.exit_code, 0) << result.error;
    return tracking::read_track_file(folder_.path(name)).rows;
  }

  TemporaryFolder folder_;
};

TEST_F(TrackCommand, CausalAndSolvedTracksDifferByNoMoreThanTheirNoise) {
  const std::string video = footage(12);
  const auto solved = tracked(video, "solved.csv"), causal = tracked(video, "causal.csv", {"--causal"});
  ASSERT_EQ(solved.size(), 12u);
  ASSERT_EQ(causal.size(), 12u);
  bool any_differs = false;
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(solved[i].frame, causal[i].frame);
    EXPECT_EQ(solved[i].time_s, causal[i].time_s);
    EXPECT_EQ(solved[i].state, causal[i].state);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(solved[i].exposure[c] / causal[i].exposure[c], 1, 0.02) << "each frame's own tag, or the neighbours' too";
    EXPECT_EQ(solved[i].noise_codes, causal[i].noise_codes);
    EXPECT_LE(solved[i].corner_sigma_px, causal[i].corner_sigma_px) << "neighbours can only add certainty";
    EXPECT_LT(tracking::turn_between_deg(solved[i].camera_from_tag, causal[i].camera_from_tag), 0.1);
    EXPECT_LT(glm::distance(solved[i].camera_from_tag.translation_m, causal[i].camera_from_tag.translation_m), 5e-4);
    any_differs |= solved[i].camera_from_tag.translation_m != causal[i].camera_from_tag.translation_m;
  }
  EXPECT_TRUE(any_differs) << "or nothing was smoothed";
}

TEST_F(TrackCommand, TheFirstFramesOfACausalTrackDoNotDependOnLaterOnes) {
  const std::string video = footage(8);
  const auto all = tracked(video, "all.csv", {"--causal"}), first = tracked(video, "first.csv", {"--causal", "--frames", "0:4"});
  ASSERT_EQ(first.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(first[i].camera_from_tag.translation_m, all[i].camera_from_tag.translation_m) << i;
}

TEST_F(TrackCommand, ProgressCountsTheFramesThatAreReadBeyondTheRange) {
  const std::string error = track(footage(6), folder_.path("track.csv"), {"--frames", "0:2"}).error;
  EXPECT_THAT(error, HasSubstr("6/26 frames")) << "a second more than the range; Matroska does not say how many there are";
}

TEST_F(TrackCommand, APartIsSaidToBeMeasuredByItself) {
  const std::string line = "may differ from the whole's";
  EXPECT_EQ(count_of(line, track(footage(28), folder_.path("part.csv"), {"--frames", "0:2"}).error), 1);
  EXPECT_EQ(count_of(line, track(footage(6), folder_.path("all.csv"), {"--frames", "0:2"}).error), 0)
      << "a second more than the part is all there is";
}

TEST_F(TrackCommand, LostFramesAreWarnedOfOnceWhereverThePosesComeFrom) {
  const std::string video = footage(3), poses = folder_.path("poses.csv"), output = folder_.path("track.csv");
  tracked(video, "poses.csv", {"--frames", "0:1"});
  const std::string two_lost = "warning: no tag in 2 of 3 frames", all_lost = "warning: the tag was never found in 3 frames";
  EXPECT_EQ(count_of(two_lost, track(video, output, {"-y", "--track", poses}).error), 1);
  EXPECT_EQ(count_of(all_lost, track(video, output, {"-y", "--tag.id", "17", "--allow-lost"}).error), 1);
  EXPECT_EQ(count_of(all_lost, track(video, output, {"-y", "--tag.id", "17", "--allow-lost", "--causal"}).error), 1);
  EXPECT_EQ(count_of("warning", track(video, output, {"-y"}).error), 0) << "nothing is lost";
}

TEST_F(TrackCommand, ATagThatIsNeverFoundIsAFailureUnlessItIsAllowed) {
  const std::string video = footage(3), output = folder_.path("track.csv");
  const CommandResult refused = track(video, output, {"--tag.id", "17"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.error, HasSubstr("error: the tag was never found in 3 frames"));
  EXPECT_THAT(refused.error, HasSubstr("give --tag.id 0"));
  EXPECT_FALSE(fs::exists(output));
  EXPECT_EQ(track(video, output, {"--tag.id", "17", "--allow-lost"}).exit_code, 0);
  EXPECT_TRUE(fs::exists(output));
  const CommandResult nothing_in_file = track(video, folder_.path("again.csv"), {"--tag.id", "17", "--track", output});
  EXPECT_EQ(nothing_in_file.exit_code, 1);
  EXPECT_THAT(nothing_in_file.error, HasSubstr("no frame of it has a pose"));
  EXPECT_EQ(track(video, output, {"-y", "--tag.id", "17", "--causal"}).exit_code, 1) << "known at the end alone";
}

TEST_F(TrackCommand, ATrackOfAnotherCameraOrTagIsRefusedAndMissingRowsAreSaidToBe) {
  const std::string video = footage(4), rows = folder_.path("rows.csv"), output = folder_.path("track.jsonl");
  tracked(video, "rows.csv", {"--frames", "0:3"});
  EXPECT_THAT(track(video, output, {"--track", rows}).error, HasSubstr("rows.csv has no row for 1 of them"));
  const CommandResult other_tag = track(video, output, {"-y", "--track", rows, "--tag.size_m", "0.2"});
  EXPECT_EQ(other_tag.exit_code, 1);
  EXPECT_THAT(other_tag.error, HasSubstr("and the scene's tag is tag36h11 #0 of 200 mm"));
  const CommandResult other_camera =
      run_catchlight({"track", video, "-y", "-o", output, "--scene", kRecording + "/scene.toml", "--fov", "60", "--track", rows});
  EXPECT_EQ(other_camera.exit_code, 1);
  EXPECT_THAT(other_camera.error, HasSubstr("was tracked with another camera"));
}

TEST_F(TrackCommand, FramesBeforeTheDamageAreSolved) {
  const std::string video = footage(12);
  const auto whole = tracked(video, "whole.csv");
  fs::resize_file(video, fs::file_size(video) / 2);
  const CommandResult result = track(video, folder_.path("damaged.csv"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("video.mkv"));
  const auto rows = tracking::read_track_file(folder_.path("damaged.csv")).rows;
  ASSERT_GE(rows.size(), 2u);
  ASSERT_LT(rows.size(), 12u);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].state, TrackState::tracking) << i;
    EXPECT_LT(tracking::turn_between_deg(rows[i].camera_from_tag, whole[i].camera_from_tag), 0.1) << i;
  }
}

}  // namespace
}  // namespace catchlight::tests
