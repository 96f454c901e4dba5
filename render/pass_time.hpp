// How long passes took.
#pragma once

#include <string>

namespace catchlight::render {

/// Milliseconds by pass name, in drawing order.
struct PassTime {
  std::string name;
  double ms;
};

}  // namespace catchlight::render
