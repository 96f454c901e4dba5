#include "app/support/log.hpp"

#include <gtest/gtest.h>

namespace catchlight::app {
namespace {

TEST(Log, AWarningIsSaidOnce) {
  Log log;
  log.set_quiet(true);
  for (int frame = 0; frame < 1000; ++frame) log.warn("a broken frame was left out");
  log.warn("another matter");
  EXPECT_EQ(log.warnings(), (std::vector<std::string>{"a broken frame was left out", "another matter"}));
}

/// A camera may run for days.
TEST(Log, WarningsAreBounded) {
  Log log;
  log.set_quiet(true);
  for (int frame = 0; frame < 100'000; ++frame) log.warn("frame " + std::to_string(frame));
  ASSERT_EQ(log.warnings().size(), Log::kMaxWarnings + 1);
  EXPECT_EQ(log.warnings().front(), "frame 0");
  EXPECT_EQ(log.warnings().back(), "there are more warnings than are shown");
}

}  // namespace
}  // namespace catchlight::app
