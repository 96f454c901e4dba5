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

TEST(OutputFile, UnwritableFolderIsFoundOutBeforeTheWork) {
  // Nobody, root included, can make files there.
  EXPECT_THAT(message_of<Error>([] { check_output_path("/proc/probe.exr", false); }), HasSubstr("/proc/probe.exr: cannot write"));
}

TEST(OutputFile, DeviceIsNotReplaced) {
  EXPECT_THAT(message_of<UsageError>([] { check_output_path("/dev/null", true); }), HasSubstr("/dev/null: is a device"));
}

TEST(OutputFile, CheckLeavesNothing) {
  const TemporaryFolder folder;
  check_output_path(folder.path("report.json"), false);
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(SharedFiles, AnOutputIsNoInputAndNoOtherOutput) {
  const TemporaryFolder folder;
  const std::string in = folder.write("in.csv", "mine"), out = folder.path("out.csv"), same = folder.path("./out.csv");
  EXPECT_NO_THROW(refuse_shared_files({out, "", "-", "-"}, {in, "", "rtsp://camera.example/live", "/nowhere/%04d.png"}));
  EXPECT_EQ(message_of<UsageError>([&] {
              refuse_shared_files({"", out, same}, {in});
            }),
            same + ": is named for two outputs; choose another name for one of them");
  EXPECT_THAT(message_of<UsageError>([&] {
                refuse_shared_files({out, folder.path("./in.csv")}, {in});
              }),
              HasSubstr("in.csv' is the input itself"));
}

}  // namespace
}  // namespace catchlight::app
