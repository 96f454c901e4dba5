#include "app/window/playing/file_watch.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "tests/support/temporary_folder.hpp"

namespace catchlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class FileWatchTest : public ::testing::Test {
 protected:
  tests::TemporaryFolder folder_;
  const std::string here_ = folder_.write("here.exr", "one"), other_ = folder_.write("other.exr", "one");
  FileWatch watch_;
};

TEST_F(FileWatchTest, TellsAChangeOnceWhenTheFileHasComeToRest) {
  watch_.watch({here_, other_});
  EXPECT_THAT(watch_.take_changed(), IsEmpty());
  folder_.write("here.exr", "longer");
  EXPECT_THAT(watch_.take_changed(), IsEmpty()) << "it may still be written";
  folder_.write("here.exr", "longer still");
  EXPECT_THAT(watch_.take_changed(), IsEmpty());
  EXPECT_THAT(watch_.take_changed(), ElementsAre(here_));
  EXPECT_THAT(watch_.take_changed(), IsEmpty());
}

TEST_F(FileWatchTest, SeesFilesComeAndGo) {
  const std::string missing = folder_.path("missing.exr");
  watch_.watch({here_, missing});
  std::filesystem::remove(here_);
  folder_.write("missing.exr", "came");
  watch_.take_changed();
  EXPECT_THAT(watch_.take_changed(), ElementsAre(here_, missing));
}

TEST_F(FileWatchTest, KeepsWhatItKnewOfFilesThatStayWatched) {
  watch_.watch({here_});
  folder_.write("here.exr", "longer");
  watch_.watch({other_, here_});
  watch_.take_changed();
  EXPECT_THAT(watch_.take_changed(), ElementsAre(here_)) << "watching more must not hide a change";
}

}  // namespace
}  // namespace catchlight::app
