#include "app/window/panels/curve.hpp"

#include <algorithm>

namespace catchlight::app {

std::vector<std::optional<double>> greatest_of_parts(const std::vector<std::optional<double>>& values, std::size_t points) {
  if (values.size() <= points) return values;
  std::vector<std::optional<double>> parts(points);
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::optional<double>& part = parts[i * points / values.size()];
    part = std::max(part, values[i]);
  }
  return parts;
}

}  // namespace catchlight::app
