#include "app/window/start/tune_state.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "tests/support/temporary_folder.hpp"

namespace catchlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class TuneStateTest : public ::testing::Test {
 protected:
  std::string recording(const std::string& name) const {
    std::filesystem::create_directories(folder_.path(name));
    return std::filesystem::canonical(folder_.path(name)).string();
  }

  tests::TemporaryFolder folder_;
  const std::string file_ = folder_.path("state/catchlight/tune.toml");
  std::vector<std::string> warnings_;
  const WarningHandler warn_ = [this](const std::string& warning) { warnings_.push_back(warning); };
};

TEST_F(TuneStateTest, ComesBackAsItWasWritten) {
  TuneState state{.width = 1920, .height = 1080, .side_width = 412.5f, .open_sections = {"glare", "pose over time"}};
  state.remember(recording("a \"quoted\" shot"));
  state.remember(recording("übung"));
  write_tune_state(file_, state, warn_);
  EXPECT_EQ(read_tune_state(file_, warn_), state);
  EXPECT_THAT(warnings_, IsEmpty());
}

TEST_F(TuneStateTest, BeginsWithoutAFile) {
  EXPECT_EQ(read_tune_state(file_, warn_), TuneState{});
  EXPECT_THAT(warnings_, IsEmpty());
}

TEST_F(TuneStateTest, WarnsOfADamagedFileAndMakesItAnew) {
  folder_.write("state/catchlight/tune.toml", "width = = 3\n\xff");
  EXPECT_EQ(read_tune_state(file_, warn_), TuneState{});
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("tune.toml: damaged, and made anew")));
  write_tune_state(file_, TuneState{.width = 1000}, warn_);
  EXPECT_EQ(read_tune_state(file_, warn_).width, 1000);
}

TEST_F(TuneStateTest, TakesNoSizeThatNobodyCouldUse) {
  folder_.write("state/catchlight/tune.toml", "width = -7\nheight = 1000000\nside_width = nan\nrecordings = 3\n");
  const TuneState state = read_tune_state(file_, warn_);
  EXPECT_GE(state.width, 320);
  EXPECT_LE(state.height, 8192);
  EXPECT_GE(state.side_width, 100);
  EXPECT_THAT(state.recordings, IsEmpty());
}

TEST_F(TuneStateTest, RemembersTheLastTenRecordingsEachOnce) {
  TuneState state;
  for (int i = 0; i < 12; ++i) state.remember(recording(std::to_string(i)));
  state.remember(recording("5") + "/../5/");
  EXPECT_EQ(state.recordings.size(), TuneState::kMaxRecordings);
  EXPECT_EQ(state.recordings[0], recording("5"));
  EXPECT_EQ(state.recordings[1], recording("11"));
  state.remember(folder_.write("video.mp4", ""));
  state.remember("camera:0");
  EXPECT_EQ(state.recordings[0], recording("5")) << "footage alone lacks the scene that the command line gave";
}

TEST_F(TuneStateTest, WarnsWhereItCannotBeWritten) {
  folder_.write("state", "a file where the folder should be");
  write_tune_state(file_, {}, warn_);
  EXPECT_EQ(warnings_.size(), 1u);
}

}  // namespace
}  // namespace catchlight::app
