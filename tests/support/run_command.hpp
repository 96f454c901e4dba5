// Runs the built program as users do.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace catchlight::tests {

struct CommandResult {
  int exit_code = -1;  ///< -1: ended by a signal
  std::string output, error;
};

/// A program with these arguments; `environment` is set on top of ours.
CommandResult run_program(const std::string& program, const std::vector<std::string>& arguments,
                          const std::map<std::string, std::string>& environment);

/// `catchlight` with these arguments; `environment` is set on top of ours.
CommandResult run_catchlight(const std::vector<std::string>& arguments,
                             const std::map<std::string, std::string>& environment = {});

/// How often `part` is in `text`.
int count_of(std::string_view part, std::string_view text);

}  // namespace catchlight::tests
