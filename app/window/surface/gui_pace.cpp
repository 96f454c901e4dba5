#include "app/window/surface/gui_pace.hpp"

#include <imgui.h>

#include <algorithm>

namespace catchlight::app {
namespace {

/// Limits what is drawn in vain where no screen sets the pace.
constexpr double kMinRest_s = 1.0 / 250;

/// Whether a hand does something: moves the pointer, holds or lets go of a button or a key, types.
bool is_in_use(const ImGuiIO& io) {
  const auto is_set = [](bool flag) { return flag; };
  return io.MouseDelta.x != 0 || io.MouseDelta.y != 0 || io.MouseWheel != 0 || std::ranges::any_of(io.MouseDown, is_set) ||
         std::ranges::any_of(io.MouseReleased, is_set) || std::ranges::any_of(io.KeysDown, is_set) ||
         !io.InputQueueCharacters.empty();
}

}  // namespace

double GuiPace::rest_s(double changes_s) {
  frames_due_ = is_in_use(ImGui::GetIO()) ? kFramesAfterInput : std::max(frames_due_ - 1, 0);
  return frames_due_ > 0 ? kMinRest_s : std::max(changes_s, kMinRest_s);
}

}  // namespace catchlight::app
