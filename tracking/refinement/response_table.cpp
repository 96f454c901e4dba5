#include "tracking/refinement/response_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace catchlight::tracking {
namespace {

/// Nodes lie evenly in each octave of light above the darkest code's, as a float's bits do: curves with a power for a shadow
/// (gamma, PQ, HLG) bend within a few octaves of black, where even steps of light would be tens of codes apart.
constexpr int kStepBits = 6, kBitsBelow = 23 - kStepBits;
constexpr float kMinLight = 0x1p-26f;  ///< a tenth of gamma 2.8's first code

std::uint32_t node_of(float light) {
  return std::bit_cast<std::uint32_t>(light) >> kBitsBelow;
}

float light_of(std::uint32_t node) {
  return std::bit_cast<float>(node << kBitsBelow);
}

/// Bisection: no transfer function falls. Of several codes of the same light, the highest.
double code_of(TransferFunction transfer, double linear, double low, double high) {
  for (int i = 0; i < 48; ++i) {
    const double middle = (low + high) / 2;
    (linear_from_code(transfer, middle) <= linear ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

ResponseTable::ResponseTable(const LumaView& luma)
    : black_code_(luma.black_code), span_(luma.white_code - luma.black_code), transfer_(luma.transfer) {
  for (int code = 0; code < 256; ++code) linear_[code] = linear_from_code(transfer_, (code - black_code_) / span_);
  first_linear_ = linear_[0];
  light_range_ = linear_[255] - first_linear_;
  constexpr double kBeyond = 0.2;  // the last node is up to 1/64 brighter than the last code
  const auto code_at = [&](double light) {
    return code_of(transfer_, first_linear_ + light, normalised(0), normalised(255) + kBeyond);
  };
  first_code_ = code_at(0);
  last_code_ = normalised(255);
  double here = code_at(kMinLight);
  for (std::uint32_t node = node_of(kMinLight); light_of(node) < light_range_; ++node) {
    const double next = code_at(light_of(node + 1)), step = light_of(node + 1) - light_of(node);
    nodes_.push_back({static_cast<float>(here), static_cast<float>((next - here) / step)});
    here = next;
  }
}

ResponseTable::Code ResponseTable::code(double linear) const {
  const double light = linear - first_linear_;
  if (!(light > 0)) return {first_code_, 0};
  if (light >= light_range_) return {last_code_, 0};
  if (light < kMinLight)
    return {first_code_ + light / kMinLight * (nodes_[0].value - first_code_), (nodes_[0].value - first_code_) / kMinLight};
  const std::uint32_t place = node_of(static_cast<float>(light));
  const Node& node = nodes_[std::min<std::size_t>(place - node_of(kMinLight), nodes_.size() - 1)];
  return {node.value + (light - light_of(place)) * node.slope, node.slope};
}

bool ResponseTable::fits(const LumaView& luma) const {
  return luma.black_code == black_code_ && luma.white_code - luma.black_code == span_ && luma.transfer == transfer_;
}

}  // namespace catchlight::tracking
