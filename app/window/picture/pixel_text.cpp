#include "app/window/picture/pixel_text.hpp"

#include <cmath>
#include <cstring>

#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

double code_of(const Plate& pixel, std::size_t channel) {
  const auto read = [&](auto value) {
    std::memcpy(&value, pixel.pixels.data() + channel * sizeof value, sizeof value);
    return value;
  };
  if (pixel.format == Plate::Format::rgb_u8) return read(std::uint8_t{}) / 255.0;
  if (pixel.format == Plate::Format::rgb_u16) return read(std::uint16_t{}) / 65535.0;
  return read(0.0f);
}

}  // namespace

int largest_code(const Frame& frame) {
  const SampleView samples = frame.codes().samples[0];
  if (samples.kind == SampleView::Kind::real) return 0;
  return samples.kind == SampleView::Kind::byte ? 255 : static_cast<int>(samples.mask);
}

std::string codes_text(const Plate& pixel, int largest, const PlateColor& color) {
  std::string codes, light;
  for (int c = 0; c < 3; ++c) {
    const double code = code_of(pixel, static_cast<std::size_t>(c));
    codes += (largest > 0 ? std::to_string(std::lround(largest * code)) : fixed_text(code, 3)) + " ";
    light += ' ' + fixed_text(linear_from_code(color, code, c), 3);
  }
  return codes + "=" + light;
}

std::string pixel_text(const Frame& frame, int x, int y) {
  return codes_text(frame.rgb({x, y, 1, 1}), largest_code(frame), frame.color());
}

}  // namespace catchlight::app
