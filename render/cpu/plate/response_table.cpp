#include "render/cpu/plate/response_table.hpp"

#include <bit>
#include <cmath>

namespace catchlight::render {
namespace {

// Steps that are even in the logarithm's sense: a float's exponent, and the first 8 bits of its fraction.
constexpr std::uint32_t kFirstBits = std::bit_cast<std::uint32_t>(1.0f / 65536);
constexpr std::uint32_t kLastBits = std::bit_cast<std::uint32_t>(16.0f);
constexpr std::uint32_t kStepBits = 15, kRestBits = (1u << kStepBits) - 1;

inline bool is_in_table(std::uint32_t bits) {
  return bits - kFirstBits < kLastBits - kFirstBits;
}

/// Which step of the table each light lies in, and where between its ends. True where some are beyond them.
[[gnu::target_clones("avx2", "default")]] bool find_steps(const Plane& linear, int count,
                                                          std::array<std::int32_t, kBlockPixels>& steps, Plane& shares) {
  int beyond = 0;
  for (int i = 0; i < count; ++i) {
    const auto bits = std::bit_cast<std::uint32_t>(linear[i]);
    const std::uint32_t above = bits - kFirstBits, last = kLastBits - kFirstBits - 1, inside = above < last ? above : last;
    beyond |= above > last ? 1 : 0;
    steps[i] = static_cast<std::int32_t>(inside >> kStepBits);
    shares[i] = static_cast<float>(static_cast<std::int32_t>(bits & kRestBits)) * (1.0f / (1u << kStepBits));
  }
  return beyond != 0;
}

}  // namespace

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

template <typename Code>
void ResponseTable::look_up(const Plate& plate, std::size_t first_pixel, int count, Planes& codes, Planes* linear) const {
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const auto code = triple<Code>(plate, first_pixel + i);
    for (std::size_t c = 0; c < 3; ++c) {
      codes[c][i] = codes_[c][code[c]];
      if (linear) (*linear)[c][i] = linear_[c][code[c]];
    }
  }
}

void ResponseTable::read(const Plate& plate, std::size_t first_pixel, int count, Planes& codes) const {
  if (plate.format == Plate::Format::rgb_u8) return look_up<std::uint8_t>(plate, first_pixel, count, codes, nullptr);
  if (plate.format == Plate::Format::rgb_u16) return look_up<std::uint16_t>(plate, first_pixel, count, codes, nullptr);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const auto code = triple<float>(plate, first_pixel + i);
    for (std::size_t c = 0; c < 3; ++c) codes[c][i] = code[c];
  }
}

void ResponseTable::read(const Plate& plate, std::size_t first_pixel, int count, Planes& codes, Planes& linear) const {
  if (plate.format == Plate::Format::rgb_u8) return look_up<std::uint8_t>(plate, first_pixel, count, codes, &linear);
  if (plate.format == Plate::Format::rgb_u16) return look_up<std::uint16_t>(plate, first_pixel, count, codes, &linear);
  read(plate, first_pixel, count, codes);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const Float4 light = linear_of_floats(plate, first_pixel + i);
    for (std::size_t c = 0; c < 3; ++c) linear[c][i] = light[static_cast<int>(c)];
  }
}

void ResponseTable::code(const Planes& linear, int channel, int count, Planes& codes) const {
  const Plane& light = linear[static_cast<std::size_t>(channel)];
  Plane& result = codes[static_cast<std::size_t>(channel)];
  if (!inverse_.empty()) {
    std::array<std::int32_t, kBlockPixels> steps;
    Plane shares;
    const bool beyond = find_steps(light, count, steps, shares);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      const float* step = &inverse_[static_cast<std::size_t>(steps[i])];
      result[i] = step[0] + shares[i] * (step[1] - step[0]);
    }
    if (!beyond) return;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    if (inverse_.empty() || !is_in_table(std::bit_cast<std::uint32_t>(light[i]))) result[i] = exact_code(light[i], channel);
}

float ResponseTable::exact_code(float linear, int channel) const {
  return static_cast<float>(code_from_linear(*response_, linear, channel));
}

}  // namespace catchlight::render
