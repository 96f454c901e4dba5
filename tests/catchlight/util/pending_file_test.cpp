#include "catchlight/util/pending_file.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "catchlight/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace catchlight {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using tests::message_of;
using tests::TemporaryFolder;

TEST(PendingFile, KeepsTheExtensionThatWritersGoBy) {
  const TemporaryFolder folder;
  const PendingFile pending(folder.path("probe.exr"));
  EXPECT_THAT(pending.pending_path(), ::testing::EndsWith(".exr"));
  EXPECT_NE(pending.pending_path(), folder.path("probe.exr"));
}

TEST(PendingFile, LeavesNothingWithoutCommit) {
  const TemporaryFolder folder;
  {
    const PendingFile pending(folder.path("probe.exr"));
    std::ofstream(pending.pending_path()) << "half";
    EXPECT_EQ(folder.names().size(), 1u);
  }
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(PendingFile, IsThereAtOnceSoThatAnUnwritableFolderIsFoundOutBeforeTheWork) {
  const TemporaryFolder folder;
  const PendingFile pending(folder.path("probe.exr"));
  EXPECT_EQ(tests::read_text(pending.pending_path()), "");
  EXPECT_THAT(folder.names(), ElementsAre(HasSubstr(".partial-")));
  // Nobody, root included, can make files there.
  EXPECT_THAT(message_of<Error>([] { PendingFile("/proc/probe.exr"); }), HasSubstr("/proc/probe.exr: cannot write"));
}

TEST(PendingFile, MovesWithoutRemovingOrCommittingTwice) {
  const TemporaryFolder folder;
  {
    PendingFile first(folder.path("probe.exr"));
    std::ofstream(first.pending_path()) << "whole";
    PendingFile second(std::move(first));
    second.commit();
  }
  EXPECT_EQ(tests::read_text(folder.path("probe.exr")), "whole");
  EXPECT_THAT(folder.names(), ElementsAre("probe.exr"));
}

TEST(PendingFile, OldFileSurvivesAFailedWriter) {
  const TemporaryFolder folder;
  const std::string path = folder.write("probe.exr", "old");
  {
    const PendingFile pending(path);
    std::ofstream(pending.pending_path()) << "half";
  }
  EXPECT_EQ(tests::read_text(path), "old");
  EXPECT_THAT(folder.names(), ElementsAre("probe.exr"));
}

TEST(PendingFile, TwoWritersOfOneTargetDoNotMeet) {
  const TemporaryFolder folder;
  PendingFile one(folder.path("probe.exr")), other(folder.path("probe.exr"));
  std::ofstream(one.pending_path()) << "one, and longer";
  std::ofstream(other.pending_path()) << "other";
  one.commit();
  EXPECT_EQ(tests::read_text(folder.path("probe.exr")), "one, and longer");
  other.commit();
  EXPECT_EQ(tests::read_text(folder.path("probe.exr")), "other");
  EXPECT_THAT(folder.names(), ElementsAre("probe.exr"));
}

TEST(PendingFile, MayBeReadByWhomTheUserAllows) {
  const TemporaryFolder folder;
  const mode_t usual = umask(022);
  PendingFile pending(folder.path("probe.exr"));
  umask(usual);
  struct stat file {};
  ASSERT_EQ(stat(pending.pending_path().c_str(), &file), 0);
  EXPECT_EQ(file.st_mode & 0777, 0644u);
}

}  // namespace
}  // namespace catchlight
