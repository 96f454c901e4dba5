// Where the frame's pixels are on the screen.
#include "app/window/picture/picture_place.hpp"

#include <gtest/gtest.h>

namespace catchlight::app {
namespace {

TEST(PicturePlace, AFramesPixelIsASquareOfTheScreen) {
  const PicturePlace place{{10, 20}, 4};
  EXPECT_EQ(place.screen_px({0, 0}), glm::vec2(12, 22)) << "the middle of the first pixel";
  EXPECT_EQ(place.screen_px({-0.5, 1.5}), glm::vec2(10, 28)) << "its left edge, and the second one's lower";
}

}  // namespace
}  // namespace catchlight::app
