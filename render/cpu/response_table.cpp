#include "render/cpu/response_table.hpp"

#include <cstring>

namespace catchlight::render {
namespace {

template <typename Code>
std::array<Code, 3> triple(const Plate& plate, std::size_t pixel) {
  std::array<Code, 3> codes;
  std::memcpy(codes.data(), plate.pixels.data() + pixel * sizeof(codes), sizeof(codes));
  return codes;
}

}  // namespace

void ResponseTable::set(const CameraResponse& response, Plate::Format format) {
  if (response_ && response_->transfer == response.transfer && response_->curve == response.curve && format_ == format) return;
  response_ = response;
  format_ = format;
  const std::size_t codes = format == Plate::Format::rgb_u8 ? 256 : format == Plate::Format::rgb_u16 ? 65536 : 0;
  codes_.resize(codes);
  for (std::size_t i = 0; i < codes; ++i) codes_[i] = static_cast<float>(i) / static_cast<float>(codes - 1);
  for (int c = 0; c < 3; ++c) {
    linear_[c].resize(codes);
    for (std::size_t i = 0; i < codes; ++i)
      linear_[c][i] = static_cast<float>(linear_from_code(response, static_cast<double>(i) / static_cast<double>(codes - 1), c));
  }
  inverse_.clear();
  if (response.curve) return;
  for (std::uint32_t bits = kFirstBits; bits <= kLastBits; bits += 1u << kStepBits)
    inverse_.push_back(exact_code(std::bit_cast<float>(bits), 0));
}

glm::vec3 ResponseTable::linear(const Plate& plate, std::size_t pixel) const {
  switch (plate.format) {
    case Plate::Format::rgb_u8: {
      const auto code = triple<std::uint8_t>(plate, pixel);
      return {linear_[0][code[0]], linear_[1][code[1]], linear_[2][code[2]]};
    }
    case Plate::Format::rgb_u16: {
      const auto code = triple<std::uint16_t>(plate, pixel);
      return {linear_[0][code[0]], linear_[1][code[1]], linear_[2][code[2]]};
    }
    default:
      break;
  }
  glm::vec3 light;
  const auto code = triple<float>(plate, pixel);
  for (int c = 0; c < 3; ++c) light[c] = static_cast<float>(linear_from_code(*response_, code[static_cast<std::size_t>(c)], c));
  return light;
}

/// `linear` may be null.
template <typename Code>
void ResponseTable::read_integers(const Plate& plate, std::size_t pixel, int count, std::size_t stride, float* codes,
                                  float* linear) const {
  for (int i = 0; i < count; ++i) {
    const auto code = triple<Code>(plate, pixel + static_cast<std::size_t>(i));
    for (std::size_t c = 0; c < 3; ++c) codes[c * stride + i] = codes_[code[c]];
    for (std::size_t c = 0; linear && c < 3; ++c) linear[c * stride + i] = linear_[c][code[c]];
  }
}

void ResponseTable::read(const Plate& plate, std::size_t pixel, int count, std::size_t stride, float* codes,
                         float* linear) const {
  if (plate.format == Plate::Format::rgb_u8) return read_integers<std::uint8_t>(plate, pixel, count, stride, codes, linear);
  if (plate.format == Plate::Format::rgb_u16) return read_integers<std::uint16_t>(plate, pixel, count, stride, codes, linear);
  for (int i = 0; i < count; ++i) {
    const auto code = triple<float>(plate, pixel + static_cast<std::size_t>(i));
    for (std::size_t c = 0; c < 3; ++c) {
      codes[c * stride + i] = code[c];
      if (linear) linear[c * stride + i] = static_cast<float>(linear_from_code(*response_, code[c], static_cast<int>(c)));
    }
  }
}

void ResponseTable::read_codes(const Plate& plate, std::size_t pixel, int count, std::size_t stride, float* codes) const {
  read(plate, pixel, count, stride, codes, nullptr);
}

float ResponseTable::exact_code(float linear, int channel) const {
  return static_cast<float>(code_from_linear(*response_, linear, channel));
}

}  // namespace catchlight::render
