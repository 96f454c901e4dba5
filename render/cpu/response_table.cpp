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

glm::vec3 ResponseTable::codes(const Plate& plate, std::size_t pixel) {
  switch (plate.format) {
    case Plate::Format::rgb_u8: {
      const auto code = triple<std::uint8_t>(plate, pixel);
      return glm::vec3(code[0], code[1], code[2]) / 255.0f;
    }
    case Plate::Format::rgb_u16: {
      const auto code = triple<std::uint16_t>(plate, pixel);
      return glm::vec3(code[0], code[1], code[2]) / 65535.0f;
    }
    default:
      const auto code = triple<float>(plate, pixel);
      return {code[0], code[1], code[2]};
  }
}

float ResponseTable::exact_code(float linear, int channel) const {
  return static_cast<float>(code_from_linear(*response_, linear, channel));
}

}  // namespace catchlight::render
