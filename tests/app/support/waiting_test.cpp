#include "app/support/waiting.hpp"

#include <gmock/gmock.h>

namespace catchlight::app {
namespace {

using std::chrono::milliseconds;

/// What is printed while `patience` has `lived` to run out in.
std::string printed(milliseconds patience, milliseconds lived) {
  Log log;
  ::testing::internal::CaptureStderr();
  {
    const Waiting waiting(log, "rtsp://camera", patience);
    std::this_thread::sleep_for(lived);
  }
  return ::testing::internal::GetCapturedStderr();
}

TEST(Waiting, WhatIsThereInTimeIsNotWaitedFor) {
  EXPECT_EQ(printed(std::chrono::hours(1), milliseconds(0)), "") << "and its end does not wait either";
}

TEST(Waiting, SaysWhatItWaitsForAndOnce) {
  EXPECT_EQ(printed(milliseconds(0), milliseconds(500)), "waiting for rtsp://camera\n");
}

}  // namespace
}  // namespace catchlight::app
