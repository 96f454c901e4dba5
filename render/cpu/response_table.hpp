// Codes to light and back for many pixels: catchlight/response's functions, looked up.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "catchlight/plate.hpp"

namespace catchlight::render {

class ResponseTable {
 public:
  /// Makes the tables anew only for another response or format.
  void set(const CameraResponse& response, Plate::Format format);

  /// A pixel's light; NaN where the plate is. `plate` must have the format of the tables.
  glm::vec3 linear(const Plate& plate, std::size_t pixel) const;

  /// Codes and light of `count` pixels from `pixel` on, channel by channel, the channels `stride` apart.
  void read(const Plate& plate, std::size_t pixel, int count, std::size_t stride, float* codes, float* linear) const;
  /// Codes alone.
  void read_codes(const Plate& plate, std::size_t pixel, int count, std::size_t stride, float* codes) const;

  /// The code of a light, to a 20 000th of a code's range between 0 and 16; exact beyond and for curves from tables.
  float code(float linear, int channel) const {
    const auto bits = std::bit_cast<std::uint32_t>(linear);
    if (inverse_.empty() || bits - kFirstBits >= kLastBits - kFirstBits) return exact_code(linear, channel);
    const std::uint32_t step = (bits - kFirstBits) >> kStepBits;
    const float share = static_cast<float>(bits & ((1u << kStepBits) - 1)) * (1.0f / (1u << kStepBits));
    return inverse_[step] + share * (inverse_[step + 1] - inverse_[step]);
  }

 private:
  // Steps that are even in the logarithm's sense: a float's exponent, and the first 8 bits of its fraction.
  static constexpr std::uint32_t kFirstBits = std::bit_cast<std::uint32_t>(1.0f / 65536);
  static constexpr std::uint32_t kLastBits = std::bit_cast<std::uint32_t>(16.0f);
  static constexpr std::uint32_t kStepBits = 15;

  template <typename Code>
  void read_integers(const Plate& plate, std::size_t pixel, int count, std::size_t stride, float* codes, float* linear) const;
  float exact_code(float linear, int channel) const;

  std::optional<CameraResponse> response_;
  Plate::Format format_ = Plate::Format::rgb_u8;
  std::array<std::vector<float>, 3> linear_;  ///< of integer codes
  std::vector<float> codes_;                  ///< of integers
  std::vector<float> inverse_;                ///< empty for a curve
};

}  // namespace catchlight::render
