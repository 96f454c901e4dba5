#include "app/window/surface/gui_keys.hpp"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace catchlight::app {
namespace {

using NamedKey = std::pair<std::string_view, int>;
constexpr std::array kNamed{
    NamedKey{"space", GLFW_KEY_SPACE}, NamedKey{"left", GLFW_KEY_LEFT},           NamedKey{"right", GLFW_KEY_RIGHT},
    NamedKey{"up", GLFW_KEY_UP},       NamedKey{"down", GLFW_KEY_DOWN},           NamedKey{"home", GLFW_KEY_HOME},
    NamedKey{"end", GLFW_KEY_END},     NamedKey{"enter", GLFW_KEY_ENTER},         NamedKey{"escape", GLFW_KEY_ESCAPE},
    NamedKey{"tab", GLFW_KEY_TAB},     NamedKey{"backspace", GLFW_KEY_BACKSPACE}, NamedKey{"delete", GLFW_KEY_DELETE},
    NamedKey{"f1", GLFW_KEY_F1}};

}  // namespace

void set_key_map(ImGuiIO& io) {
  io.KeyMap[ImGuiKey_Tab] = GLFW_KEY_TAB;
  io.KeyMap[ImGuiKey_LeftArrow] = GLFW_KEY_LEFT;
  io.KeyMap[ImGuiKey_RightArrow] = GLFW_KEY_RIGHT;
  io.KeyMap[ImGuiKey_UpArrow] = GLFW_KEY_UP;
  io.KeyMap[ImGuiKey_DownArrow] = GLFW_KEY_DOWN;
  io.KeyMap[ImGuiKey_Home] = GLFW_KEY_HOME;
  io.KeyMap[ImGuiKey_End] = GLFW_KEY_END;
  io.KeyMap[ImGuiKey_Delete] = GLFW_KEY_DELETE;
  io.KeyMap[ImGuiKey_Backspace] = GLFW_KEY_BACKSPACE;
  io.KeyMap[ImGuiKey_Space] = GLFW_KEY_SPACE;
  io.KeyMap[ImGuiKey_Enter] = GLFW_KEY_ENTER;
  io.KeyMap[ImGuiKey_Escape] = GLFW_KEY_ESCAPE;
  io.KeyMap[ImGuiKey_A] = GLFW_KEY_A;
  io.KeyMap[ImGuiKey_C] = GLFW_KEY_C;
  io.KeyMap[ImGuiKey_V] = GLFW_KEY_V;
  io.KeyMap[ImGuiKey_X] = GLFW_KEY_X;
  io.KeyMap[ImGuiKey_Y] = GLFW_KEY_Y;
  io.KeyMap[ImGuiKey_Z] = GLFW_KEY_Z;
}

std::optional<int> key_number(std::string_view name) {
  const auto named = std::ranges::find(kNamed, name, &NamedKey::first);
  if (named != kNamed.end()) return named->second;
  if (name.size() != 1 || name.front() <= ' ' || name.front() > '~') return {};
  return std::toupper(static_cast<unsigned char>(name.front()));  // GLFW numbers printable keys by their characters
}

bool is_key_down(std::string_view name) {
  const std::optional<int> key = key_number(name);
  return key && ImGui::IsKeyDown(*key);
}

bool is_key_pressed(std::string_view name) {
  const std::optional<int> key = key_number(name);
  return key && ImGui::IsKeyPressed(*key);
}

}  // namespace catchlight::app
