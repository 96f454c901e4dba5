// How a camera's codes stand for light: by formula, or by a table where no formula has it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "catchlight/color.hpp"

namespace catchlight {

/// Light of evenly spaced codes from 0 to 1, a table a channel, red first. Straight lines between; beyond the ends the first and
/// the last line go on, so that codes outside limited range, and light beyond white, have their places.
class ResponseCurve {
 public:
  using Tables = std::array<std::vector<float>, 3>;

  /// At least two values a channel, equally many, finite, each above the one before.
  explicit ResponseCurve(Tables light) : light_(std::move(light)) {}

  const Tables& light() const { return light_; }
  std::size_t size() const { return light_[0].size(); }

  double linear_from_code(double code, int channel) const {
    const std::vector<float>& light = light_[static_cast<std::size_t>(channel)];
    const double place = code * static_cast<double>(size() - 1);
    const double step = std::clamp(std::floor(place), 0.0, static_cast<double>(size() - 2));
    const double from = light[static_cast<std::size_t>(step)], to = light[static_cast<std::size_t>(step) + 1];
    return from + (place - step) * (to - from);
  }

  double code_from_linear(double linear, int channel) const {
    const std::vector<float>& light = light_[static_cast<std::size_t>(channel)];
    const auto above = std::upper_bound(light.begin() + 1, light.end() - 1, linear);
    const double from = *(above - 1), to = *above;
    return (static_cast<double>(above - 1 - light.begin()) + (linear - from) / (to - from)) / static_cast<double>(size() - 1);
  }

 private:
  Tables light_;
};

/// The whole of a camera's response: a curve stands in for the formula.
struct CameraResponse {
  TransferFunction transfer = TransferFunction::srgb;
  std::shared_ptr<const ResponseCurve> curve = {};
};

}  // namespace catchlight
