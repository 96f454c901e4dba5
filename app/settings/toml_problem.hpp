// What is wrong with a TOML file, in words for people who wrote it.
#pragma once

#include <string>
#include <string_view>

namespace catchlight::app {

/// What toml++ says of a file that is none (the description of its parse_error) as what was expected and what to do.
std::string toml_problem(std::string_view description);

}  // namespace catchlight::app
