// What a pixel holds, in codes and in light.
#include "app/window/picture/pixel_text.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace catchlight::tests {
namespace {

using namespace catchlight::app;

template <class Code>
Plate pixel(Plate::Format format, const std::array<Code, 3>& codes) {
  Plate plate{{0, 0, 1, 1}, format, {}};
  plate.pixels.resize(sizeof codes);
  std::memcpy(plate.pixels.data(), codes.data(), sizeof codes);
  return plate;
}

TEST(PixelText, SaysCodesAndTheirLight) {
  const PlateColor linear{{TransferFunction::linear}};
  EXPECT_EQ(codes_text(pixel<std::uint8_t>(Plate::Format::rgb_u8, {255, 51, 0}), 255, linear), "255 51 0 = 1.000 0.200 0.000");
  const PlateColor srgb{};
  EXPECT_EQ(codes_text(pixel<std::uint8_t>(Plate::Format::rgb_u8, {188, 188, 188}), 255, srgb),
            "188 188 188 = 0.503 0.503 0.503");
}

TEST(PixelText, DeepFootageHasItsOwnCodes) {
  const PlateColor linear{{TransferFunction::linear}};
  EXPECT_EQ(codes_text(pixel<std::uint16_t>(Plate::Format::rgb_u16, {65535, 32768, 0}), 1023, linear),
            "1023 512 0 = 1.000 0.500 0.000");
  EXPECT_EQ(codes_text(pixel<float>(Plate::Format::rgb_f32, {2.5f, 1, -0.125f}), 0, linear),
            "2.500 1.000 -0.125 = 2.500 1.000 -0.125");
}

TEST(PixelText, FollowsTheFootagesOwnCurve) {
  const auto curve = std::make_shared<ResponseCurve>(
      ResponseCurve::Tables{std::vector<float>{0, 0.1f, 1}, std::vector<float>{0, 0.2f, 1}, std::vector<float>{0, 0.3f, 1}});
  const PlateColor color{{TransferFunction::srgb, curve}};
  EXPECT_EQ(codes_text(pixel<float>(Plate::Format::rgb_f32, {0.5f, 0.5f, 0.5f}), 0, color),
            "0.500 0.500 0.500 = 0.100 0.200 0.300");
}

}  // namespace
}  // namespace catchlight::tests
