#include "render/cpu/plate/response_table.hpp"

#include <cmath>

namespace catchlight::render {

void ResponseTable::set(const CameraResponse& response, Plate::Format format) {
  if (response_ && response_->transfer == response.transfer && response_->curve == response.curve && format_ == format) return;
  response_ = response;
  format_ = format;
  const std::size_t codes = format == Plate::Format::rgb_u8 ? 256 : format == Plate::Format::rgb_u16 ? 65536 : 0;
  for (std::size_t c = 0; c < 3; ++c) {
    linear_[c].resize(codes), codes_[c].resize(codes);
    for (std::size_t i = 0; i < codes; ++i) {
      const double code = static_cast<double>(i) / static_cast<double>(codes - 1);
      codes_[c][i] = static_cast<float>(code);
      linear_[c][i] = static_cast<float>(linear_from_code(response, code, static_cast<int>(c)));
    }
  }
  inverse_.clear();
  if (response.curve) return;
  for (std::uint32_t bits = kFirstBits; bits <= kLastBits; bits += 1u << kStepBits)
    inverse_.push_back(exact_code(std::bit_cast<float>(bits), 0));
}

Float4 ResponseTable::linear_of_floats(const Plate& plate, std::size_t pixel) const {
  const auto code = triple<float>(plate, pixel);
  Float4 light{};
  for (int c = 0; c < 3; ++c) {
    const auto value = static_cast<float>(linear_from_code(*response_, code[static_cast<std::size_t>(c)], c));
    light[c] = std::isfinite(value) ? value : 0;
  }
  return light;
}

float ResponseTable::exact_code(float linear, int channel) const {
  return static_cast<float>(code_from_linear(*response_, linear, channel));
}

}  // namespace catchlight::render
