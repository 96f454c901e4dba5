#include "tracking/response_table.hpp"

#include <algorithm>
#include <cmath>

namespace catchlight::tracking {
namespace {

constexpr int kSteps = 2048;  ///< sRGB is within 0.02 codes between them, and the table stays in the cache

/// Bisection: every transfer function rises.
double code_of(TransferFunction transfer, double linear, double low, double high) {
  for (int i = 0; i < 48; ++i) {
    const double middle = (low + high) / 2;
    (linear_from_code(transfer, middle) < linear ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

ResponseTable::ResponseTable(const LumaView& luma)
    : black_code_(luma.black_code), span_(luma.white_code - luma.black_code), transfer_(luma.transfer) {
  for (int code = 0; code < 256; ++code) linear_[code] = linear_from_code(transfer_, (code - black_code_) / span_);
  const double lowest = normalised(0), highest = normalised(255);
  first_linear_ = linear_[0];
  steps_per_linear_ = kSteps / (linear_[255] - first_linear_);
  codes_.reserve(kSteps + 1);
  double code = lowest;
  for (int i = 0; i <= kSteps; ++i) {
    code = code_of(transfer_, first_linear_ + i / steps_per_linear_, code, highest);
    codes_.push_back(static_cast<float>(code));
  }
}

ResponseTable::Code ResponseTable::code(double linear) const {
  const double place = (linear - first_linear_) * steps_per_linear_;
  if (!(place > 0)) return {codes_.front(), 0};
  if (place >= kSteps) return {codes_.back(), 0};
  const int i = static_cast<int>(place);
  const double from = codes_[static_cast<std::size_t>(i)], rise = codes_[static_cast<std::size_t>(i) + 1] - from;
  return {from + (place - i) * rise, rise * steps_per_linear_};
}

bool ResponseTable::fits(const LumaView& luma) const {
  return luma.black_code == black_code_ && luma.white_code - luma.black_code == span_ && luma.transfer == transfer_;
}

}  // namespace catchlight::tracking
