// Order statistics: always one of the values, never between two.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace catchlight {

/// The value with `below` others before it, were they sorted.
template <class Value>
Value nth_smallest(std::vector<Value> values, std::size_t below) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(below);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// The middle value; of an even number, the upper of the two in the middle. `values` must not be empty.
template <class Value>
Value median(std::vector<Value> values) {
  const std::size_t below = values.size() / 2;
  return nth_smallest(std::move(values), below);
}

/// The value at this share of the way through the sorted ones: the smallest at 0, the largest at 1; between two, the smaller.
/// `values` must not be empty.
template <class Value>
Value quantile(std::vector<Value> values, double share) {
  const auto below = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  return nth_smallest(std::move(values), below);
}

}  // namespace catchlight
