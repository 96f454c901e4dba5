#include "catchlight/plate.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace catchlight {
namespace {

template <typename Code>
RawVector<float> linear_of(const Plate& plate, const PlateColor& color, double full_scale) {
  RawVector<float> linear(plate.pixels.size() / sizeof(Code));
  std::array<std::vector<float>, 3> tables;
  if constexpr (sizeof(Code) == 1)
    for (int channel = 0; channel < 3; ++channel)
      for (int code = 0; code < 256; ++code)
        tables[static_cast<std::size_t>(channel)].push_back(
            static_cast<float>(linear_from_code(color, code / full_scale, channel)));
  for (std::size_t i = 0; i < linear.size(); ++i) {
    Code code;
    std::memcpy(&code, &plate.pixels[i * sizeof(Code)], sizeof(Code));
    if constexpr (sizeof(Code) == 1)
      linear[i] = tables[i % 3][code];
    else
      linear[i] = static_cast<float>(linear_from_code(color, static_cast<double>(code) / full_scale, static_cast<int>(i % 3)));
  }
  return linear;
}

RawVector<float> linear_of(const Plate& plate, const PlateColor& color) {
  switch (plate.format) {
    case Plate::Format::rgb_u8:
      return linear_of<std::uint8_t>(plate, color, 255);
    case Plate::Format::rgb_u16:
      return linear_of<std::uint16_t>(plate, color, 65535);
    case Plate::Format::rgb_f32:
      return linear_of<float>(plate, color, 1);
  }
  return {};
}

}  // namespace

std::vector<unsigned char> codes_8_bit(const Plate& plate) {
  std::vector<unsigned char> codes(3 * static_cast<std::size_t>(plate.rect.width) * plate.rect.height);
  const auto convert = [&](const auto* from, float to_code) {
    for (std::size_t i = 0; i < codes.size(); ++i)
      codes[i] = static_cast<unsigned char>(glm::clamp(static_cast<float>(from[i]) * to_code, 0.0f, 255.0f) + 0.5f);
  };
  switch (plate.format) {
    case Plate::Format::rgb_u8:
      std::memcpy(codes.data(), plate.pixels.data(), codes.size());
      break;
    case Plate::Format::rgb_u16:
      convert(reinterpret_cast<const std::uint16_t*>(plate.pixels.data()), 1.0f / 257);
      break;
    case Plate::Format::rgb_f32:
      convert(reinterpret_cast<const float*>(plate.pixels.data()), 255);
      break;
  }
  return codes;
}

RawVector<float> linear_rgb(const Plate& plate, const PlateColor& color) {
  RawVector<float> linear = linear_of(plate, color);
  if (color.plate_from_rec709 != glm::mat3(1.0f)) {
    const glm::mat3 rec709_from_plate = glm::inverse(color.plate_from_rec709);
    for (std::size_t i = 0; i + 2 < linear.size(); i += 3) {
      const glm::vec3 rgb = rec709_from_plate * glm::vec3(linear[i], linear[i + 1], linear[i + 2]);
      std::memcpy(&linear[i], &rgb, sizeof rgb);
    }
  }
  return linear;
}

glm::dvec3 clipping_linear(Plate::Format format, const PlateColor& color) {
  if (format == Plate::Format::rgb_f32) return glm::dvec3(std::numeric_limits<double>::infinity());
  return {linear_from_code(color, kClippingCode, 0), linear_from_code(color, kClippingCode, 1),
          linear_from_code(color, kClippingCode, 2)};
}

}  // namespace catchlight
