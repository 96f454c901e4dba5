#include "render/cpu/plate/response_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace catchlight::render {
namespace {

constexpr TransferFunction kTransfers[] = {TransferFunction::srgb,    TransferFunction::linear, TransferFunction::gamma22,
                                           TransferFunction::gamma28, TransferFunction::pq,     TransferFunction::hlg};

/// Another curve in each channel.
CameraResponse measured() {
  ResponseCurve::Tables tables;
  for (std::size_t c = 0; c < 3; ++c)
    for (int i = 0; i < 256; ++i) tables[c].push_back(std::pow(static_cast<float>(i) / 255, 1.8f + 0.4f * static_cast<float>(c)));
  return {TransferFunction::srgb, std::make_shared<ResponseCurve>(tables)};
}

std::vector<CameraResponse> responses() {
  std::vector<CameraResponse> all{measured()};
  for (const TransferFunction transfer : kTransfers) all.push_back({transfer, {}});
  return all;
}

template <typename Code>
Plate plate_of(const std::vector<Code>& codes, Plate::Format format) {
  Plate plate{{0, 0, static_cast<int>(codes.size() / 3), 1}, format, RawVector<std::byte>(codes.size() * sizeof(Code))};
  std::memcpy(plate.pixels.data(), codes.data(), plate.pixels.size());
  return plate;
}

/// The code of one light, looked up among others.
float code_of(const ResponseTable& table, float light, int channel) {
  Planes linear, codes;
  for (Plane& plane : linear) plane.fill(0.5f);
  constexpr std::size_t kSomewhere = 77;
  linear[static_cast<std::size_t>(channel)][kSomewhere] = light;
  table.code(linear, channel, kBlockPixels, codes);
  return codes[static_cast<std::size_t>(channel)][kSomewhere];
}

template <typename Code>
std::vector<Code> all_codes() {
  std::vector<Code> codes;
  for (std::size_t i = 0; i <= std::numeric_limits<Code>::max(); ++i) codes.insert(codes.end(), 3, static_cast<Code>(i));
  return codes;
}

template <typename Code>
void expect_light_of_all_codes(Plate::Format format) {
  const Plate plate = plate_of(all_codes<Code>(), format);
  const double last = std::numeric_limits<Code>::max();
  for (const CameraResponse& response : responses()) {
    ResponseTable table;
    table.set(response, format);
    for (std::size_t i = 0; i <= std::numeric_limits<Code>::max(); ++i) {
      const Float4 light = table.linear(plate, i);
      Planes linear, codes;
      table.read(plate, i, 1, codes, linear);
      for (std::size_t c = 0; c < 3; ++c) {
        const double expected = linear_from_code(response, static_cast<double>(i) / last, static_cast<int>(c));
        ASSERT_EQ(light[static_cast<int>(c)], static_cast<float>(expected)) << i;
        ASSERT_EQ(linear[c][0], static_cast<float>(expected)) << i;
        ASSERT_NEAR(codes[c][0], static_cast<double>(i) / last, 1e-7);
      }
    }
  }
}

TEST(ResponseTable, HoldsTheLightOfAllCodesOfEightBits) {
  expect_light_of_all_codes<std::uint8_t>(Plate::Format::rgb_u8);
}

TEST(ResponseTable, HoldsTheLightOfAllCodesOfSixteenBits) {
  expect_light_of_all_codes<std::uint16_t>(Plate::Format::rgb_u16);
}

TEST(ResponseTable, FindsTheLightOfFloatsBeyondBlackAndWhiteToo) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> codes{-0.5f, 0, 0.3f, 0.99f, 1.7f, nan};
  const Plate plate = plate_of(codes, Plate::Format::rgb_f32);
  for (const CameraResponse& response : responses()) {
    ResponseTable table;
    table.set(response, Plate::Format::rgb_f32);
    Planes linear, read;
    table.read(plate, 0, 2, read, linear);
    for (std::size_t i = 0; i < 5; ++i) {
      const auto expected = static_cast<float>(linear_from_code(response, codes[i], static_cast<int>(i % 3)));
      EXPECT_EQ(table.linear(plate, i / 3)[static_cast<int>(i % 3)], expected);
      EXPECT_EQ(linear[i % 3][i / 3], expected);
      EXPECT_EQ(read[i % 3][i / 3], codes[i]);
    }
    EXPECT_EQ(table.linear(plate, 1)[2], 0) << "what is no number is black";
    EXPECT_EQ(linear[2][1], 0);
    EXPECT_TRUE(std::isnan(read[2][1]));
  }
}

TEST(ResponseTable, CodesLightToA20000thOfTheRange) {
  for (const CameraResponse& response : responses()) {
    ResponseTable table;
    table.set(response, Plate::Format::rgb_u8);
    double worst = 0;
    for (double light = 1e-7; light < 16; light *= 1.0007)
      for (int c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(code_of(table, static_cast<float>(light), c) -
                                         code_from_linear(response, static_cast<float>(light), c)));
    EXPECT_LE(worst, 1.0 / 20000) << static_cast<int>(response.transfer);
  }
}

TEST(ResponseTable, CodesOtherLightExactly) {
  for (const CameraResponse& response : responses()) {
    ResponseTable table;
    table.set(response, Plate::Format::rgb_u16);
    const float inf = std::numeric_limits<float>::infinity();
    for (const float light : {-inf, -3.0f, -1e-3f, -0.0f, 0.0f, 1e-30f, 1e-6f, 16.0f, 17.5f, 1e4f, 1e30f}) {
      const auto expected = static_cast<float>(code_from_linear(response, light, 1));
      EXPECT_TRUE(code_of(table, light, 1) == expected || (std::isnan(expected) && std::isnan(code_of(table, light, 1))))
          << light;
    }
  }
}

TEST(ResponseTable, RisesWithTheLight) {
  ResponseTable table;
  table.set({TransferFunction::srgb, {}}, Plate::Format::rgb_u8);
  float last = code_of(table, 0, 0);
  for (double light = 1e-6; light < 20; light *= 1.0001) {
    const float code = code_of(table, static_cast<float>(light), 0);
    ASSERT_GE(code, last) << light;
    last = code;
  }
}

TEST(ResponseTable, FollowsTheResponse) {
  ResponseTable table;
  const Plate plate = plate_of(std::vector<std::uint8_t>{128, 128, 128}, Plate::Format::rgb_u8);
  for (const CameraResponse& response : responses()) {
    table.set(response, Plate::Format::rgb_u8);
    EXPECT_EQ(table.linear(plate, 0)[1], static_cast<float>(linear_from_code(response, 128.0 / 255, 1)));
    EXPECT_NEAR(code_of(table, 0.3f, 1), code_from_linear(response, 0.3f, 1), 1.0 / 20000);
  }
}

}  // namespace
}  // namespace catchlight::render
