#include "app/media/frame_range.hpp"

#include <gmock/gmock.h>

#include "catchlight/error.hpp"
#include "tests/support/media_fixture.hpp"

namespace catchlight::app::testing {
namespace {

using ::testing::HasSubstr;

TEST(FrameRange, IsHalfOpenAndMayLackAnEnd) {
  EXPECT_TRUE(parse_frame_range("10:20").contains(10));
  EXPECT_FALSE(parse_frame_range("10:20").contains(20));
  EXPECT_TRUE(parse_frame_range("10:").contains(1'000'000));
  EXPECT_TRUE(parse_frame_range(":20").contains(0));
  EXPECT_TRUE(parse_frame_range("7").contains(7));
  EXPECT_FALSE(parse_frame_range("7").contains(8));
  EXPECT_TRUE(parse_frame_range("").contains(123));
}

/// Those who know slices of Python would mean the last five frames, and would get all of them.
TEST(FrameRange, NumbersBelowZeroAreRefused) {
  for (const char* text : {"-5:", "-5:10", ":-1", "-1"})
    EXPECT_THAT(message_of<UsageError>([&] { parse_frame_range(text); }), HasSubstr("no frame has a number below 0")) << text;
}

TEST(FrameRange, WhatIsNoRangeIsRefused) {
  for (const char* text : {"5:5", "7:3"})
    EXPECT_THAT(message_of<UsageError>([&] { parse_frame_range(text); }), HasSubstr("empty")) << text;
  for (const char* text : {"a:b", "1-5", "1:2:3", "5 :7", ":x"})
    EXPECT_THAT(message_of<UsageError>([&] { parse_frame_range(text); }), HasSubstr("expected A:B")) << text;
}

}  // namespace
}  // namespace catchlight::app::testing
