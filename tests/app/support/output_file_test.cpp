#include "app/support/output_file.hpp"
#include "catchlight/error.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace catchlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using tests::message_of;
using tests::TemporaryFolder;

TEST(OutputFile, HoldsTheTextAndNothingElseIsLeft) {
  const TemporaryFolder folder;
  write_text_file(folder.path("report.json"), "text\n", false);
  EXPECT_EQ(tests::read_text(folder.path("report.json")), "text\n");
  EXPECT_THAT(folder.names(), ElementsAre("report.json"));
}

TEST(OutputFile, IsOverwrittenOnlyWhenAsked) {
  const TemporaryFolder folder;
  const std::string path = folder.write("report.json", "old");
  EXPECT_THAT(message_of<UsageError>([&] { write_text_file(path, "new", false); }), HasSubstr("exists already; pass -y"));
  EXPECT_EQ(tests::read_text(path), "old");
  write_text_file(path, "new", true);
  EXPECT_EQ(tests::read_text(path), "new");
}

TEST(OutputFile, MissingFolderIsNamed) {
  const TemporaryFolder folder;
  const std::string path = folder.path("none/report.json");
  EXPECT_THAT(message_of<Error>([&] { write_text_file(path, "text", false); }),
              HasSubstr("there is no folder " + folder.path("none")));
}

TEST(OutputFile, FolderInItsPlaceIsRefusedEvenForOverwriting) {
  const TemporaryFolder folder;
  EXPECT_THAT(message_of<UsageError>([&] { check_output_path(folder.path(), true); }), HasSubstr("is a folder"));
}

TEST(OutputFile, EmptyNameIsRefused) {
  EXPECT_THROW(check_output_path("", true), UsageError);
}

TEST(PendingFile, KeepsTheExtensionThatWritersGoBy) {
  const TemporaryFolder folder;
  const PendingFile pending(folder.path("probe.exr"), false);
  EXPECT_THAT(pending.pending_path(), ::testing::EndsWith(".exr"));
  EXPECT_NE(pending.pending_path(), folder.path("probe.exr"));
}

TEST(PendingFile, LeavesNothingWithoutCommit) {
  const TemporaryFolder folder;
  {
    const PendingFile pending(folder.path("probe.exr"), false);
    std::ofstream(pending.pending_path()) << "half";
    EXPECT_EQ(folder.names().size(), 1u);
  }
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(PendingFile, IsThereAtOnceSoThatAnUnwritableFolderIsFoundOutBeforeTheWork) {
  const TemporaryFolder folder;
  const PendingFile pending(folder.path("probe.exr"), false);
  EXPECT_EQ(tests::read_text(pending.pending_path()), "");
  EXPECT_THAT(folder.names(), ElementsAre(HasSubstr(".partial-")));
  // Nobody, root included, can make files there.
  EXPECT_THAT(message_of<Error>([] { PendingFile("/proc/probe.exr", false); }), HasSubstr("/proc/probe.exr: cannot write"));
}

TEST(PendingFile, MovesWithoutRemovingOrCommittingTwice) {
  const TemporaryFolder folder;
  {
    PendingFile first(folder.path("probe.exr"), false);
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
    const PendingFile pending(path, true);
    std::ofstream(pending.pending_path()) << "half";
  }
  EXPECT_EQ(tests::read_text(path), "old");
  EXPECT_THAT(folder.names(), ElementsAre("probe.exr"));
}

}  // namespace
}  // namespace catchlight::app
