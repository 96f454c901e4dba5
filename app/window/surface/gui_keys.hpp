// The numbers that keys have in ImGui's IO: GLFW's, on every surface.
#pragma once

#include <optional>
#include <string_view>

struct ImGuiIO;

namespace catchlight::app {

void set_key_map(ImGuiIO& io);

/// By name as scripts write it: "space", "left", "home", "f1", "a", "[", ...
std::optional<int> key_number(std::string_view name);

/// Whether the named key is held.
bool is_key_down(std::string_view name);

/// Whether the named key went down in this frame; held keys repeat.
bool is_key_pressed(std::string_view name);

}  // namespace catchlight::app
