#include "render/cpu/plate/plate_composite.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>
#include <set>

#include "catchlight/error.hpp"
#include "catchlight/response.hpp"

namespace catchlight::render {
namespace {

constexpr PixelRect kFrame{0, 0, 64, 48};

/// An 8-bit plate, a view whose codes are light, and images of the whole frame that change nothing.
class PlateComposite : public ::testing::Test {
 protected:
  PlateComposite() {
    view_.camera = {.width_px = 64, .height_px = 48, .fx_px = 60, .fy_px = 60, .cx_px = 31.5, .cy_px = 23.5};
    view_.color.transfer = TransferFunction::linear;
    std::ranges::fill(shadow_.data, 1.0f);
    plate_.pixels.resize(3 * 64 * 48);
    for (std::size_t i = 0; i < plate_.pixels.size(); ++i) plate_.pixels[i] = static_cast<std::byte>(i * 7 % 250);
  }

  void make_floats(float code) {
    const std::vector<float> codes(3 * 64 * 48, code);
    plate_.format = Plate::Format::rgb_f32;
    plate_.pixels.resize(codes.size() * 4);
    std::memcpy(plate_.pixels.data(), codes.data(), plate_.pixels.size());
  }

  Composite composite(bool as_light = false, const PixelRect& rect = kFrame, const CompositeSink& take = {}) {
    Composite result;
    result.rect = rect;
    ResponseTable response;
    response.set(view_.color, plate_.format);
    VirtualImages images;
    images.object = &object_, images.object_rect = kFrame;
    images.shadow = [&](int x, int y, int count, const std::array<float*, 3>& ratio) {
      for (int i = 0; i < count; ++i)
        for (std::size_t c = 0; c < 3; ++c) ratio[c][i] = shadow_.pixel(x + i, y)[c];
      return true;
    };
    images.passed_at_tag = 1;
    images.glare = glare_;
    composite_plate(view_, plate_, response, images, as_light, take, result);
    return result;
  }

  /// The table of the plate as it is first, in eight bits.
  glm::vec3 code(int x, int y) const {
    const std::byte* codes = &plate_.pixels[3 * static_cast<std::size_t>(y * 64 + x)];
    return glm::vec3(std::to_integer<int>(codes[0]), std::to_integer<int>(codes[1]), std::to_integer<int>(codes[2])) / 255.0f;
  }

  static glm::vec4 pixel_of(const Composite& result, int x, int y) {
    const float* p = &result.rgba[4 * static_cast<std::size_t>((y - result.rect.y) * result.rect.width + x - result.rect.x)];
    return {p[0], p[1], p[2], p[3]};
  }

  FrameView view_;
  Plate plate_{kFrame, Plate::Format::rgb_u8, {}};
  Image object_{64, 48, 4}, shadow_{64, 48, 4};
  GlareRow glare_;
};

TEST_F(PlateComposite, KeepsTheCodesOfWhatIsNotTouched) {
  for (const TransferFunction transfer : {TransferFunction::srgb, TransferFunction::pq, TransferFunction::linear}) {
    view_.color.transfer = transfer;
    const Composite result = composite();
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 64; ++x) EXPECT_EQ(pixel_of(result, x, y), glm::vec4(code(x, y), 0));
  }
}

TEST_F(PlateComposite, PutsLightOverLight) {
  view_.black = {0.1f, 0, 0.02f};
  const glm::vec4 object(0.1f, 0.2f, 0.05f, 0.25f);
  const glm::vec3 ratio(0.5f, 0.6f, 1), glare(0.01f, 0, 0.02f);
  std::memcpy(object_.pixel(10, 9), &object, sizeof object);
  std::memcpy(shadow_.pixel(10, 9), &ratio, sizeof ratio);
  glare_ = [&](int, int, int count, float* rgb) {
    for (int i = 0; i < count; ++i) std::memcpy(rgb + 3 * i, &glare, sizeof glare);
  };
  const glm::vec4 found = pixel_of(composite(), 10, 9);
  for (int c = 0; c < 3; ++c) {
    const float plate = code(10, 9)[c], black = view_.black[c];
    const float shadowed = std::max(plate - black, 0.0f) * ratio[c] + std::min(plate, black);
    EXPECT_NEAR(found[c], 0.75f * shadowed + object[c] + 0.25f * black + glare[c], 1e-4) << c;
  }
  EXPECT_EQ(found.w, 1);
}

TEST_F(PlateComposite, ClippedCodesHideLight) {
  view_.receiver_light = glm::vec3(2);
  std::ranges::fill(plate_.pixels, std::byte{255});
  shadow_.pixel(3, 3)[0] = 0.4f, shadow_.pixel(3, 3)[1] = 0.8f, shadow_.pixel(3, 3)[2] = 0.99f;
  const glm::vec4 found = pixel_of(composite(), 3, 3);
  EXPECT_NEAR(found.x, 0.8f, 1e-4);
  EXPECT_EQ(found.y, 1) << "integers end at 1";
  EXPECT_EQ(found.z, 1);
  make_floats(1);
  EXPECT_NEAR(pixel_of(composite(), 3, 3).x, 0.4f, 1e-5) << "floats do not clip";
}

TEST_F(PlateComposite, FloatsGoOnBeyondWhiteAndBlack) {
  make_floats(0.5f);
  const glm::vec4 object(40, -0.25f, 0, 0.5f);
  std::memcpy(object_.pixel(20, 20), &object, sizeof object);
  const glm::vec4 found = pixel_of(composite(), 20, 20);
  EXPECT_NEAR(found.x, 40.25f, 1e-3);
  EXPECT_NEAR(found.y, 0, 1e-5);
}

TEST_F(PlateComposite, APlateThatIsNoNumberShowsThroughNowhere) {
  make_floats(std::numeric_limits<float>::quiet_NaN());
  const glm::vec4 object(0.3f, 0.3f, 0.3f, 1);
  std::memcpy(object_.pixel(20, 20), &object, sizeof object);
  const Composite result = composite();
  EXPECT_EQ(pixel_of(result, 20, 20), glm::vec4(0.3f, 0.3f, 0.3f, 1));
  EXPECT_TRUE(std::isnan(pixel_of(result, 21, 20).x));
  EXPECT_EQ(pixel_of(result, 21, 20).w, 0);
}

TEST_F(PlateComposite, VignettingDarkensTheObjectAsThePlateIs) {
  view_.camera.vignetting = {-0.5, 0, 0};
  const glm::vec4 object(0.8f, 0.8f, 0.8f, 1);
  for (const auto& [x, y] : {std::pair(0, 0), {31, 23}, {60, 5}}) std::memcpy(object_.pixel(x, y), &object, sizeof object);
  const Composite result = composite();
  for (const auto& [x, y] : {std::pair(0, 0), {31, 23}, {60, 5}})
    EXPECT_NEAR(pixel_of(result, x, y).x, 0.8 * vignetting_at(view_.camera, {x, y}), 1e-4) << x;
}

TEST_F(PlateComposite, NoiseHasTheVarianceThatIsMissing) {
  make_floats(0.5f);
  view_.effects.noise = {true, glm::vec3(2e-4f), glm::vec3(1e-5f), glm::mat3(1), {0, 0}, 3};
  const auto variance = [&](double mean) {
    const Composite result = composite();
    double sum = 0;
    for (std::size_t i = 1; i < result.rgba.size(); i += 4) sum += (result.rgba[i] - mean) * (result.rgba[i] - mean);
    return sum / (64 * 48);
  };
  EXPECT_EQ(variance(0.5), 0) << "what is not touched is the plate";
  for (std::size_t i = 0; i < object_.data.size(); ++i) object_.data[i] = i % 4 == 3 ? 1.0f : 0.3f;
  EXPECT_NEAR(variance(0.3) / (2e-4 * 0.3 + 1e-5), 1, 0.1) << "4 standard deviations";
  for (std::size_t i = 0; i < object_.data.size(); ++i) object_.data[i] = i % 4 == 3 ? 0.5f : 0.15f;
  EXPECT_NEAR(variance(0.4) / (2e-4 * 0.4 + 1e-5 - 0.25 * (2e-4 * 0.5 + 1e-5)), 1, 0.1);
}

TEST_F(PlateComposite, IsTheSameInAnyRectangle) {
  view_.effects.noise = {true, glm::vec3(2e-4f), glm::vec3(1e-5f), glm::mat3(1), {1, 1}, 3};
  for (std::size_t i = 0; i < object_.data.size(); ++i) object_.data[i] = static_cast<float>(i % 13) / 20;
  const Composite whole = composite(), part = composite(false, {17, 9, 21, 30});
  for (int y = 9; y < 39; ++y)
    for (int x = 17; x < 38; ++x) EXPECT_EQ(pixel_of(whole, x, y), pixel_of(part, x, y));
}

TEST_F(PlateComposite, BandsHoldWhatChanges) {
  for (int y = 0; y < 48; ++y)
    for (int x = 20; x < 40; ++x)
      for (int c = 0; c < 3; ++c) shadow_.pixel(x, y)[c] = 0.5f;
  const PixelRect rect{3, 5, 60, 40};
  const Composite whole = composite(false, rect);
  std::mutex mutex;
  std::set<int> rows;
  const Composite rest = composite(false, rect, [&](const Composite& band) {
    const std::lock_guard lock(mutex);
    EXPECT_EQ(band.plate.get(), &plate_);
    EXPECT_LE(band.rect.y % kCompositeBandRows + band.rect.height, kCompositeBandRows);
    for (int y = band.rect.y; y < band.rect.y + band.rect.height; ++y) {
      EXPECT_TRUE(rows.insert(y).second);
      for (int x = rect.x; x < rect.x + rect.width; ++x) {
        ASSERT_EQ(pixel_of(band, x, y).w, pixel_of(whole, x, y).w);
        if (pixel_of(whole, x, y).w > 0) {
          ASSERT_EQ(pixel_of(band, x, y), pixel_of(whole, x, y));
        }
      }
    }
  });
  EXPECT_EQ(rows.size(), 40u);
  EXPECT_TRUE(rest.rgba.empty());
  EXPECT_EQ(rest.rect, rect);
}

TEST_F(PlateComposite, AsLightIsWhatTheCodesStandFor) {
  view_.color.transfer = TransferFunction::srgb;
  for (std::size_t i = 0; i < object_.data.size(); ++i) object_.data[i] = static_cast<float>(i % 11 + 1) / 20;
  const Composite light = composite(true), codes = composite();
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) {
      EXPECT_EQ(pixel_of(light, x, y).w, 1);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(std::clamp(code_from_linear(view_.color, pixel_of(light, x, y)[c], c), 0.0, 1.0), pixel_of(codes, x, y)[c],
                    6e-5);
    }
}

TEST_F(PlateComposite, RefusesAPlateOfAnotherSize) {
  plate_.pixels.pop_back();
  EXPECT_THROW(composite(), Error);
}

}  // namespace
}  // namespace catchlight::render
