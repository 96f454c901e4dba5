#include "app/photometry/linear_patch.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace catchlight::app {

namespace {

template <typename Code>
void append_linear(const Plate& plate, const PlateColor& color, double full_scale, std::vector<float>& linear) {
  const std::size_t count = plate.pixels.size() / sizeof(Code);
  linear.resize(count);
  std::array<std::vector<float>, 3> tables;
  if constexpr (sizeof(Code) == 1)
    for (int channel = 0; channel < 3; ++channel)
      for (int code = 0; code < 256; ++code)
        tables[static_cast<std::size_t>(channel)].push_back(
            static_cast<float>(linear_from_code(color, code / full_scale, channel)));
  for (std::size_t i = 0; i < count; ++i) {
    Code code;
    std::memcpy(&code, &plate.pixels[i * sizeof(Code)], sizeof(Code));
    if constexpr (sizeof(Code) == 1)
      linear[i] = tables[i % 3][code];
    else
      linear[i] = static_cast<float>(linear_from_code(color, static_cast<double>(code) / full_scale, static_cast<int>(i % 3)));
  }
}

}  // namespace

std::vector<float> linear_rgb(const Frame& frame, const PixelRect& rect) {
  const Plate plate = frame.rgb(rect);
  const PlateColor color = frame.color();
  std::vector<float> linear;
  switch (plate.format) {
    case Plate::Format::rgb_u8:
      append_linear<std::uint8_t>(plate, color, 255, linear);
      break;
    case Plate::Format::rgb_u16:
      append_linear<std::uint16_t>(plate, color, 65535, linear);
      break;
    case Plate::Format::rgb_f32:
      append_linear<float>(plate, color, 1, linear);
      break;
  }
  if (color.plate_from_rec709 != glm::mat3(1.0f)) {
    const glm::mat3 rec709_from_plate = glm::inverse(color.plate_from_rec709);
    for (std::size_t i = 0; i + 2 < linear.size(); i += 3) {
      const glm::vec3 rgb = rec709_from_plate * glm::vec3(linear[i], linear[i + 1], linear[i + 2]);
      std::memcpy(&linear[i], &rgb, sizeof rgb);
    }
  }
  return linear;
}

glm::dvec3 clipped_linear(const Frame& frame) {
  if (frame.is_float()) return glm::dvec3(std::numeric_limits<double>::infinity());
  glm::dvec3 clipped;
  for (int channel = 0; channel < 3; ++channel) clipped[channel] = linear_from_code(frame.color(), 250.0 / 255, channel);
  return clipped;
}

double linear_from_code(const PlateColor& color, double code, int channel) {
  return color.curve ? color.curve->linear_from_code(code, channel) : catchlight::linear_from_code(color.transfer, code);
}

double code_from_linear(const PlateColor& color, double linear, int channel) {
  return color.curve ? color.curve->code_from_linear(linear, channel) : code_from_linear(color.transfer, linear);
}

double code_from_linear(TransferFunction transfer, double linear) {
  const double light = std::max(linear, 0.0);
  switch (transfer) {
    case TransferFunction::srgb:
      return srgb_from_linear(linear);
    case TransferFunction::linear:
      return linear;
    case TransferFunction::gamma22:
      return std::pow(light, 1 / 2.2);
    case TransferFunction::gamma28:
      return std::pow(light, 1 / 2.8);
    case TransferFunction::pq: {
      const double root = std::pow(light * 203.0 / 10000.0, 2610.0 / 16384.0);
      return std::pow((0.8359375 + 18.8515625 * root) / (1 + 18.6875 * root), 2523.0 / 32.0);
    }
    case TransferFunction::hlg: {
      const double scene = light * 0.26496256;
      return scene <= 1.0 / 12 ? std::sqrt(3 * scene) : 0.17883277 * std::log(12 * scene - 0.28466892) + 0.55991073;
    }
  }
  return linear;
}

}  // namespace catchlight::app
