// The plan: what the program chose, and why.
#pragma once

#include <string>

namespace catchlight::app {

/// One choice of the plan, e.g. {"bands", "6", "set by hand"}.
struct PlanEntry {
  std::string choice, value, reason;
};

}  // namespace catchlight::app
