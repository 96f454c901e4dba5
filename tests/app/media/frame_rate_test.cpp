#include "app/media/frame_rate.hpp"

#include <gtest/gtest.h>

#include "catchlight/error.hpp"

namespace catchlight::app {
namespace {

TEST(FrameRate, IsANumberOrAQuotient) {
  EXPECT_EQ(frame_rate_from_text("25"), 25);
  EXPECT_EQ(frame_rate_from_text("12.5"), 12.5);
  EXPECT_EQ(frame_rate_from_text("24000/1001"), 24000.0 / 1001);
  EXPECT_EQ(frame_rate_from_text("50/2"), 25);
}

TEST(FrameRate, NtscIsMeantWhereItIsRounded) {
  for (const char* text : {"23.976", "23.98", "23.9760"}) EXPECT_EQ(frame_rate_from_text(text), 24 * (1000.0 / 1001)) << text;
  EXPECT_EQ(frame_rate_from_text("29.97"), 30 * (1000.0 / 1001));
  EXPECT_EQ(frame_rate_from_text("59.94"), 60 * (1000.0 / 1001));
  EXPECT_EQ(frame_rate_from_text("24"), 24);
}

TEST(FrameRate, WhatIsNoneIsRefused) {
  for (const char* text : {"", "0", "-24", "24fps", "24/0", "0/0", "1/2/3", "nan", "inf", "1e9"})
    EXPECT_THROW(frame_rate_from_text(text), UsageError) << text;
}

}  // namespace
}  // namespace catchlight::app
