// The camera's response as a table: from linear light to codes, with their slope, and from codes to light.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "catchlight/luma_view.hpp"
#include "catchlight/response.hpp"

namespace catchlight::tracking {

/// Codes are normalised here: 0 is the stream's black, 1 its white; 8-bit codes beyond them stay beyond.
class ResponseTable {
 public:
  explicit ResponseTable(const LumaView& luma);

  struct Code {
    double value, slope;  ///< slope: per unit of light; 0 where the code is clipped
  };

  Code code(double linear) const;
  double linear(std::uint8_t code) const { return linear_[code]; }
  double linear_of(double normalised_code) const { return linear_from_code(transfer_, normalised_code); }
  double normalised(std::uint8_t code) const { return (code - black_code_) / span_; }
  double codes_per_unit() const { return span_; }

  /// Whether the table was made for frames like this one.
  bool fits(const LumaView& luma) const;

 private:
  double black_code_, span_;
  TransferFunction transfer_;
  std::array<double, 256> linear_;
  double first_linear_, light_range_;  ///< from the light of code 0 to that of code 255
  double first_code_, last_code_;
  struct Node {
    float value, slope;
  };
  std::vector<Node> nodes_;
};

}  // namespace catchlight::tracking
