// Which glare a setting chooses, and that an aperture's reaches the frame's rows.
#include <gtest/gtest.h>

#include <algorithm>

#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "render/cpu/glare/make_cpu_glare.hpp"
#include "render/glare/fft_glare.hpp"
#include "render/settings.hpp"

namespace catchlight::render::test {
namespace {

const CameraModel kCamera{
    .width_px = 81, .height_px = 60, .fx_px = 90, .fy_px = 90, .cx_px = 40, .cy_px = 29.5, .distortion = {}};

TEST(ApertureGlare, IsTheConvolutionOfTheExcess) {
  GlareSettings settings;
  settings.method = GlareMethod::fft;
  Image object(20, 10, 4);
  std::fill_n(object.pixel(7, 5), 3, 500.0f);
  const PixelRect rect{50, 40, 20, 10};
  const std::unique_ptr<CpuGlare> glare = make_cpu_glare(settings);
  ASSERT_TRUE(glare->extract(object, nullptr, rect, 81, 60));
  EXPECT_EQ(intersect(glare->spread(kCamera), {57, 45, 1, 1}), (PixelRect{57, 45, 1, 1}));
  const Image expected = FftGlare(settings).spread(*excess_of(object, rect, 81, 60, settings), kCamera);
  EXPECT_GT(expected.pixel(57, 45)[0], 0.1f);
  std::vector<float> row(3 * 31);
  for (int y = 0; y < 60; ++y) {
    glare->read_row(50, y, 31, row.data());
    for (int i = 0; i < 3 * 31; ++i) ASSERT_EQ(row[static_cast<std::size_t>(i)], expected.pixel(50, y)[i]) << i << ", " << y;
  }
}

TEST(ApertureGlare, IsNoneWhereNothingIsBright) {
  GlareSettings settings;
  settings.method = GlareMethod::fft;
  EXPECT_FALSE(make_cpu_glare(settings)->extract(Image(20, 10, 4), nullptr, {0, 0, 20, 10}, 81, 60));
}

TEST(ApertureGlare, RefusesAnApertureThatIsNone) {
  GlareSettings settings;
  settings.aperture = "blades:1";
  EXPECT_NO_THROW(make_cpu_glare(settings)) << "not used";
  settings.method = GlareMethod::fft;
  EXPECT_THROW(make_cpu_glare(settings), Error);
}

}  // namespace
}  // namespace catchlight::render::test
