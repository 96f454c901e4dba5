#include "app/support/progress.hpp"
#include "catchlight/progress.hpp"

#include <gmock/gmock.h>

#include <algorithm>

namespace catchlight::app {
namespace {

using ::testing::HasSubstr;

/// What `work` prints to stderr, which is not a terminal meanwhile.
template <class Work>
std::string printed_by(Work&& work) {
  ::testing::internal::CaptureStderr();
  work();
  return ::testing::internal::GetCapturedStderr();
}

TEST(ProgressText, ShowsShareRateAndWhatIsLeft) {
  EXPECT_EQ(progress_text("overlay", 18, 36, "frames", 9.0),
            "overlay [##############              ] 18/36 frames, 2.0 /s, 9 s left");
}

TEST(ProgressText, FullBarHasNothingLeft) {
  EXPECT_EQ(progress_text("overlay", 36, 36, "frames", 9.0), "overlay [############################] 36/36 frames, 4.0 /s");
}

TEST(ProgressText, MoreThanAnnouncedFillsTheBarAndNoMore) {
  EXPECT_THAT(progress_text("overlay", 40, 36, "frames", 10.0), HasSubstr("[############################] 40/36"));
}

TEST(ProgressText, UnknownTotalShowsTheCount) {
  EXPECT_EQ(progress_text("track", 12, {}, "frames", 4.0), "track 12 frames, 3.0 /s");
}

TEST(ProgressText, StartHasNoRateYet) {
  EXPECT_EQ(progress_text("track", 0, {}, "frames", 0.0), "track 0 frames");
  EXPECT_EQ(progress_text("track", 12, {}, "frames", 0.001), "track 12 frames") << "too early to tell a rate";
  EXPECT_EQ(progress_text("track", 0, 0, "frames", 0.0), "track 0/0 frames");
}

TEST(Progress, PrintsALineEveryTenthWhereThereIsNoTerminal) {
  Log log;
  const std::string text = printed_by([&] {
    Progress progress(log, "overlay", 1000);
    for (int frame = 1; frame <= 1000; ++frame) progress.update(frame);
  });
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 10);
  EXPECT_EQ(text.find('\r'), std::string::npos);
  EXPECT_THAT(text, HasSubstr("100/1000 frames"));
  EXPECT_THAT(text, HasSubstr("1000/1000 frames"));
}

TEST(Progress, IsSilentWhenQuiet) {
  Log log;
  log.set_quiet(true);
  EXPECT_EQ(printed_by([&] { Progress(log, "overlay", 2).update(2); }), "");
}

TEST(ProgressHandler, CountsPerCent) {
  Log log;
  const std::string text = printed_by([&] {
    const ProgressHandler progress = progress_handler(log, "bake");
    for (int i = 0; i <= 64; ++i) progress(i / 64.0);
  });
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 10);
  EXPECT_THAT(text, HasSubstr("] 100 %"));
}

TEST(Log, QuietKeepsWarningsForTheReportAndErrorsOnTheScreen) {
  Log log;
  log.set_quiet(true);
  const std::string text = printed_by([&] {
    log.info("information");
    log.warn("a warning");
    log.error("an error");
  });
  EXPECT_EQ(text, "catchlight: error: an error\n");
  EXPECT_THAT(log.warnings(), ::testing::ElementsAre("a warning"));
}

TEST(Log, HasNoColorsWhereThereIsNoTerminal) {
  Log log;
  EXPECT_EQ(printed_by([&] { log.warning_handler()("a warning"); }), "catchlight: warning: a warning\n");
}

}  // namespace
}  // namespace catchlight::app
