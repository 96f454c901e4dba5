// Curves over many frames, as many points as there is room for.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace catchlight::app {

/// `values` in `points` parts of equal length, or as they are where there are fewer: the greatest of each, none where it has
/// none.
std::vector<std::optional<double>> greatest_of_parts(const std::vector<std::optional<double>>& values, std::size_t points);

}  // namespace catchlight::app
