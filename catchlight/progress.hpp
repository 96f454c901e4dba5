// How a long task tells how far it is.
#pragma once

#include <functional>

namespace catchlight {

/// Receives the finished share of a long task, 0 to 1, never decreasing.
using ProgressHandler = std::function<void(double)>;

}  // namespace catchlight
