// The glare of an aperture on the CPU: what of a frame glares, and how it is scaled.
#include "render/glare/fft_glare.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "render/glare/glare_kernel.hpp"
#include "render/settings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace catchlight::render {
namespace {

constexpr int kWidth = 160, kHeight = 120;
constexpr PixelRect kWhole{0, 0, kWidth, kHeight};
const CameraModel kCamera{
    .width_px = kWidth, .height_px = kHeight, .fx_px = 200, .fy_px = 200, .cx_px = 79.5, .cy_px = 59.5, .distortion = {}};

GlareSettings of_aperture(const std::string& name, double strength = 1) {
  GlareSettings settings;
  settings.method = GlareMethod::fft;
  settings.aperture = name;
  settings.aperture_mm = 0.2;
  settings.aperture_strength = strength;
  return settings;
}

Image black_frame() {
  return Image(kWidth, kHeight, 4);
}

void set(Image& frame, int x, int y, float r, float g, float b) {
  float* pixel = frame.pixel(x, y);
  pixel[0] = r, pixel[1] = g, pixel[2] = b, pixel[3] = 1;
}

double sum(const Image& image, int channel) {
  double total = 0;
  for (std::size_t i = static_cast<std::size_t>(channel); i < image.data.size(); i += 3) total += image.data[i];
  return total;
}

std::optional<Image> excess_of_frame(const Image& frame) {
  return excess_of(frame, kWhole, kWidth, kHeight, {});
}

TEST(FftGlare, NothingGlaresThatTheSensorCanHold) {
  EXPECT_FALSE(excess_of_frame(black_frame()));
  Image white = black_frame();
  std::fill(white.data.begin(), white.data.end(), 1.0f);
  EXPECT_FALSE(excess_of_frame(white)) << "white itself does not exceed white";
}

TEST(FftGlare, AHighlightKeepsItsColourAndIsHeldBelowTheBrightest) {
  Image frame = black_frame();
  set(frame, 50, 40, 400, 200, 100);
  const Image excess = *excess_of_frame(frame);
  EXPECT_NEAR(excess.pixel(50, 40)[0], 400, 2);
  EXPECT_NEAR(excess.pixel(50, 40)[1] / excess.pixel(50, 40)[0], 0.5, 1e-5);
  EXPECT_NEAR(excess.pixel(50, 40)[2] / excess.pixel(50, 40)[0], 0.25, 1e-5);
  set(frame, 50, 40, 1e8f, 1e8f, 1e8f);
  EXPECT_LT(excess_of_frame(frame)->pixel(50, 40)[0], 3e5f);
}

TEST(FftGlare, OnlyTheObjectsRectangleGlaresWhereItLies) {
  Image object(20, 10, 4);
  std::fill(object.data.begin(), object.data.end(), 5.0f);
  const Image excess = *excess_of(object, {-5, 115, 20, 10}, kWidth, kHeight, {});
  EXPECT_GT(excess.pixel(0, 115)[0], 1.0f);
  EXPECT_GT(excess.pixel(14, 119)[0], 1.0f);
  EXPECT_EQ(excess.pixel(15, 119)[0], 0.0f);
  EXPECT_EQ(excess.pixel(0, 114)[0], 0.0f);
}

TEST(FftGlare, TheExcessOfAHighlightThatMovesWithinAPixelStays) {
  double low = 1e9, high = 0;
  for (int step = 0; step <= 20; ++step) {
    const float share = 0.05f * static_cast<float>(step);
    Image frame = black_frame();
    set(frame, 50, 40, 100 * (1 - share), 0, 0);
    set(frame, 51, 40, 100 * share, 0, 0);
    const double energy = sum(*excess_of_frame(frame), 0);
    low = std::min(low, energy);
    high = std::max(high, energy);
  }
  EXPECT_LT(high / low, 1.01);
}

TEST(FftGlare, ASunPixelShowsThePointSpreadFunctionTimesTheStrength) {
  Image excess(kWidth, kHeight);
  for (int c = 0; c < 3; ++c) excess.pixel(80, 60)[c] = 1000;
  const Image once = FftGlare(of_aperture("blades:6")).spread(excess, kCamera);
  const ApertureOptics optics{0.2, 200};
  const AperturePlan plan = plan_aperture(optics, kWidth, 1 << 20);
  const Image psf = aperture_psf({aperture_picture("blades:6").draw(plan.picture_px), plan.transform_px}, optics, plan.reach_px);
  EXPECT_LT(once.pixel(80, 60)[1], 2e-3f) << "the middle is the pixel's own";
  for (const int d : {1, 2, 5, 10})
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(once.pixel(80 + d, 60 + d)[c], 1000 * psf.pixel(plan.reach_px + d, plan.reach_px + d)[c], 1e-3) << d;
  const Image thrice = FftGlare(of_aperture("blades:6", 3)).spread(excess, kCamera);
  EXPECT_NEAR(sum(thrice, 1) / sum(once, 1), 3, 0.05);
  EXPECT_EQ(sum(FftGlare(of_aperture("blades:6", 0)).spread(excess, kCamera), 1), 0);
}

TEST(FftGlare, EveryFrameGivesFiniteLight) {
  const float values[] = {std::numeric_limits<float>::quiet_NaN(),
                          std::numeric_limits<float>::infinity(),
                          1e38f,
                          -5.0f,
                          std::ldexp(1.0f, 20),
                          std::ldexp(1.0f, -20)};
  FftGlare glare(of_aperture("circle"));
  for (const float value : values) {
    Image frame = black_frame();
    set(frame, 30, 30, value, 1, value);
    set(frame, 90, 60, 3, 3, 3);
    const std::optional<Image> excess = excess_of_frame(frame);
    ASSERT_TRUE(excess) << value;
    for (const float light : glare.spread(*excess, kCamera).data) ASSERT_TRUE(std::isfinite(light) && light >= 0) << value;
  }
}

TEST(FftGlare, FollowsAChangeOfTheCamera) {
  FftGlare glare(of_aperture("circle"));
  Image excess(kWidth, kHeight);
  excess.pixel(80, 60)[1] = 1e4f;
  const Image wide = glare.spread(excess, kCamera);
  CameraModel longer = kCamera;
  longer.fx_px = longer.fy_px = 400;
  EXPECT_GT(glare.spread(excess, longer).pixel(90, 60)[1], 1.5f * wide.pixel(90, 60)[1])
      << "further away at a longer focal length";
  EXPECT_EQ(glare.spread(excess, kCamera).data, wide.data);
}

TEST(FftGlare, WithoutAnApertureItIsTheKernelOfTheFastPasses) {
  GlareSettings settings = of_aperture("none");
  Image excess(kWidth, kHeight);
  excess.pixel(80, 60)[1] = 1000;
  const Image glare = FftGlare(settings).spread(excess, kCamera), kernel = glare_kernel(settings, kHeight, 41, 41);
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 41; ++x) {
      const float expected = 1000 * kernel.pixel(x, y)[1];
      ASSERT_NEAR(glare.pixel(60 + x, 40 + y)[1], expected, 1e-4 + 1e-3 * expected) << x << ' ' << y;
    }
}

TEST(FftGlare, SaysWhichApertureItCannotUse) {
  EXPECT_THROW(FftGlare(of_aperture("no such file.png")), Error);
}

}  // namespace
}  // namespace catchlight::render
