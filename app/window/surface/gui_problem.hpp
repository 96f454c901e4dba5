// What is wrong, where it is seen.
#pragma once

#include <string>

namespace catchlight::app {

/// Writes the text over the lower end of the current ImGui window, as many lines as it takes.
void draw_problem(const std::string& text);

}  // namespace catchlight::app
