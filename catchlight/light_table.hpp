// Codes to light, for many pixels.
#pragma once

#include <vector>

#include "catchlight/response.hpp"

namespace catchlight {

/// linear_from_code() from a table: straight lines between 4096 codes from 0 to 1, within 1e-6 of the formula's light or of 1,
/// whichever is more. Codes beyond are by the formula, and curves, which are tables, by themselves.
class LightTable {
 public:
  explicit LightTable(const CameraResponse& response);

  float operator()(float code, int channel) const {
    if (response_.curve || !(code >= 0 && code <= 1)) return static_cast<float>(linear_from_code(response_, code, channel));
    const float place = code * kSteps;
    const auto step = std::min(static_cast<std::size_t>(place), static_cast<std::size_t>(kSteps - 1));
    const float from = (*light_)[step], to = (*light_)[step + 1];
    return from + (place - static_cast<float>(step)) * (to - from);
  }

 private:
  static constexpr int kSteps = 4096;
  static std::vector<float> tabulated(TransferFunction transfer);

  CameraResponse response_;
  const std::vector<float>* light_;  ///< made once for each formula
};

}  // namespace catchlight
