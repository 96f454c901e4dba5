#include "app/window/playing/playhead.hpp"

#include <gtest/gtest.h>

namespace catchlight::app {
namespace {

Playhead playing(std::int64_t frames, PlayMode mode) {
  Playhead playhead;
  playhead.set_frame_count(frames);
  playhead.mode = mode;
  playhead.toggle();
  return playhead;
}

/// The positions that a window shows, each of whose frames takes as long as `frames_each` of the footage.
std::vector<std::int64_t> positions(Playhead playhead, int count, double frames_each = 1) {
  std::vector<std::int64_t> shown;
  for (int i = 0; i < count; ++i) {
    shown.push_back(playhead.position());
    playhead.advance(frames_each / 24 + 1e-9, 24);
  }
  return shown;
}

using Positions = std::vector<std::int64_t>;

TEST(Playhead, Loops) {
  EXPECT_EQ(positions(playing(3, PlayMode::loop), 7), (Positions{0, 1, 2, 0, 1, 2, 0}));
}

TEST(Playhead, GoesToAndFro) {
  EXPECT_EQ(positions(playing(3, PlayMode::ping_pong), 8), (Positions{0, 1, 2, 1, 0, 1, 2, 1}));
}

TEST(Playhead, PlaysOnceAndStaysAtTheEnd) {
  EXPECT_EQ(positions(playing(3, PlayMode::once), 5), (Positions{0, 1, 2, 2, 2}));
}

TEST(Playhead, LeavesOutWhatCouldNotBeShown) {
  EXPECT_EQ(positions(playing(10, PlayMode::loop), 4, 4), (Positions{0, 4, 8, 2}));
  EXPECT_EQ(positions(playing(1, PlayMode::ping_pong), 3, 7), (Positions{0, 0, 0}));
}

TEST(Playhead, ShowsAFrameAsLongAsItLasts) {
  EXPECT_EQ(positions(playing(5, PlayMode::loop), 6, 0.5), (Positions{0, 0, 1, 1, 2, 2}));
}

TEST(Playhead, TellsHowLongItStays) {
  Playhead playhead = playing(5, PlayMode::loop);
  EXPECT_NEAR(playhead.until_next_s(25).value(), 0.04, 1e-9);
  playhead.advance(0.015, 25);
  EXPECT_NEAR(playhead.until_next_s(25).value(), 0.025, 1e-9);
  playhead.toggle();
  EXPECT_FALSE(playhead.until_next_s(25)) << "until it is moved";
}

TEST(Playhead, PlaysTheMarkedRange) {
  Playhead playhead = playing(10, PlayMode::loop);
  playhead.toggle();
  playhead.go_to(3), playhead.mark_begin();
  playhead.go_to(5), playhead.mark_end();
  playhead.toggle();
  EXPECT_EQ(positions(playhead, 5), (Positions{5, 3, 4, 5, 3}));
  playhead.clear_marks();
  EXPECT_EQ(playhead.end(), 10);
}

TEST(Playhead, StaysWithinTheFootage) {
  Playhead playhead;
  playhead.go_to(5);
  EXPECT_EQ(playhead.position(), 0) << "no footage yet";
  playhead.set_frame_count(4);
  playhead.step(100);
  EXPECT_EQ(playhead.position(), 3);
  playhead.step(-100);
  EXPECT_EQ(playhead.position(), 0);
}

}  // namespace
}  // namespace catchlight::app
