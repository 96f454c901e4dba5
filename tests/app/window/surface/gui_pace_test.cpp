#include "app/window/surface/gui_pace.hpp"

#include <gtest/gtest.h>
#include <imgui.h>

namespace catchlight::app {
namespace {

class GuiPaceTest : public ::testing::Test {
 protected:
  GuiPaceTest() {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {640, 480};
    io.MousePos = {10, 10};
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
  }
  ~GuiPaceTest() override { ImGui::DestroyContext(); }

  /// After a frame under the input that ImGui's IO holds, in a window that changes only after ten seconds.
  double rest_s() {
    ImGui::NewFrame();
    const double rest = pace_.rest_s(10);
    ImGui::EndFrame();
    return rest;
  }

  /// Frames that are drawn at once before the window rests.
  int frames_at_once() {
    int frames = 0;
    while (frames < 100 && rest_s() < 1) ++frames;
    return frames;
  }

  GuiPace pace_;
};

TEST_F(GuiPaceTest, RestsAfterItsFirstFrames) {
  EXPECT_GT(frames_at_once(), 0) << "the layout needs a frame or two";
  for (int frame = 0; frame < 5; ++frame) EXPECT_EQ(rest_s(), 10);
}

TEST_F(GuiPaceTest, AnswersThePointerAndThenRests) {
  frames_at_once();
  ImGui::GetIO().MousePos.x += 1;
  EXPECT_GE(frames_at_once(), 2);
  EXPECT_EQ(rest_s(), 10);
}

TEST_F(GuiPaceTest, GoesOnWhileAButtonIsHeld) {
  frames_at_once();
  ImGui::GetIO().MouseDown[0] = true;
  for (int frame = 0; frame < 20; ++frame) EXPECT_LT(rest_s(), 0.01) << "it may repeat, or drag";
  ImGui::GetIO().MouseDown[0] = false;
  EXPECT_GE(frames_at_once(), 2);
}

TEST_F(GuiPaceTest, TakesLettersAndKeys) {
  frames_at_once();
  ImGui::GetIO().AddInputCharacter('a');
  EXPECT_LT(rest_s(), 0.01);
}

}  // namespace
}  // namespace catchlight::app
