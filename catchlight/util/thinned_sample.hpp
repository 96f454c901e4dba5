// A bounded record of an unbounded series.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace catchlight {

/// All values of a series as long as they are at most kMaxValues; of a longer one every second, fourth, ... value, evenly spread
/// over the whole series. Deterministic.
template <class Value, std::size_t max_values = 4096>
class ThinnedSample {
 public:
  static constexpr std::size_t kMaxValues = max_values;

  void add(Value value) {
    if (seen_++ % stride_ != 0) return;
    values_.push_back(std::move(value));
    if (values_.size() <= kMaxValues) return;
    for (std::size_t i = 1; 2 * i < values_.size(); ++i) values_[i] = std::move(values_[2 * i]);
    values_.erase(values_.begin() + static_cast<std::ptrdiff_t>((values_.size() + 1) / 2), values_.end());
    stride_ *= 2;
  }

  const std::vector<Value>& values() const { return values_; }

 private:
  std::vector<Value> values_;
  std::size_t seen_ = 0, stride_ = 1;
};

}  // namespace catchlight
