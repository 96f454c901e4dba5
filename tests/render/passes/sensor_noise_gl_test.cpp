// The sensor's noise on the virtual layer: its moments, and where it may not be.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "catchlight/composite.hpp"
#include "catchlight/pixel_rect.hpp"
#include "render/frame_view.hpp"
#include "render/render_scene.hpp"
#include "tests/support/gl_fixture.hpp"
#include "tests/support/renderers.hpp"

namespace catchlight::render::test {
namespace {

template <typename Renderer>
using SensorNoiseGl = EachRenderer<Renderer>;
TYPED_TEST_SUITE(SensorNoiseGl, Renderers, RendererNames);

/// The whole picture is a square of light 0.5; codes are light.
RenderScene grey_wall() {
  Material grey;
  grey.base_color = glm::vec3(0.5f);
  grey.dielectric_f0 = 0;
  return constant_scene(square({-1, -1}, {1, 1}, 0), grey, glm::vec3(1));
}

FrameView noisy_view(std::uint32_t frame = 7) {
  FrameView view = linear_view_from_above();
  view.effects.noise = {true, {2e-4f, 3e-4f, 4e-4f}, {1e-5f, 1e-5f, 1e-5f}, glm::mat3(1.0f), {0, 0}, frame};
  return view;
}

std::vector<double> channel(const Composite& composite, std::size_t c, double mean) {
  std::vector<double> values;
  for (std::size_t i = c; i < composite.rgba.size(); i += 4) values.push_back(composite.rgba[i] - mean);
  return values;
}

double moment(const std::vector<double>& a, const std::vector<double>& b, std::size_t lag = 0) {
  double sum = 0;
  for (std::size_t i = 0; i + lag < a.size(); ++i) sum += a[i] * b[i + lag];
  return sum / static_cast<double>(a.size() - lag);
}

constexpr double kPixels = 160 * 120;

TYPED_TEST(SensorNoiseGl, HasTheVarianceAskedForAndNoMean) {
  TypeParam compositor(grey_wall(), without_glare());
  const FrameView view = noisy_view();
  const Composite composite = compositor.render(view, linear_grey_plate());
  ASSERT_EQ(composite.rect, (PixelRect{0, 0, 160, 120}));
  for (int c = 0; c < 3; ++c) {
    const std::vector<double> noise = channel(composite, static_cast<std::size_t>(c), 0.5);
    const double expected = view.effects.noise.slope[c] * 0.5 + view.effects.noise.floor[c], variance = moment(noise, noise);
    EXPECT_NEAR(std::accumulate(noise.begin(), noise.end(), 0.0) / kPixels, 0, 4 * std::sqrt(expected / kPixels)) << c;
    EXPECT_NEAR(variance / expected, 1, 4 * std::sqrt(2 / kPixels)) << c;
    double fourth = 0;
    for (const double n : noise) fourth += n * n * n * n / kPixels / variance / variance;
    EXPECT_NEAR(fourth, 3, 0.3) << "normal, but for a kurtosis 0.15 too small";
  }
}

TYPED_TEST(SensorNoiseGl, PixelsChannelsAndFramesAreIndependent) {
  TypeParam compositor(grey_wall(), without_glare());
  const Composite one = compositor.render(noisy_view(7), linear_grey_plate()),
                  next = compositor.render(noisy_view(8), linear_grey_plate());
  const auto correlation = [](const std::vector<double>& a, const std::vector<double>& b, std::size_t lag) {
    return moment(a, b, lag) / std::sqrt(moment(a, a) * moment(b, b));
  };
  const double sigma = 1 / std::sqrt(kPixels);
  const auto red = channel(one, 0, 0.5), green = channel(one, 1, 0.5);
  EXPECT_NEAR(correlation(red, green, 0), 0, 4 * sigma);
  for (const std::size_t lag : {1, 2, 3, 159, 160, 161, 320}) EXPECT_NEAR(correlation(red, red, lag), 0, 4 * sigma) << lag;
  for (const std::size_t lag : {0, 1, 160}) EXPECT_NEAR(correlation(red, channel(next, 0, 0.5), lag), 0, 4 * sigma) << lag;
}

TYPED_TEST(SensorNoiseGl, AFrameIsTheSameEveryTimeAndInAnyRectangle) {
  TypeParam compositor(grey_wall(), without_glare());
  EXPECT_EQ(compositor.render(noisy_view(3), linear_grey_plate()).rgba,
            compositor.render(noisy_view(3), linear_grey_plate()).rgba);
}

TYPED_TEST(SensorNoiseGl, ColourIsSharedByABlockAndLumaIsNot) {
  TypeParam compositor(grey_wall(), without_glare());
  FrameView view = noisy_view();
  view.effects.noise.slope = glm::vec3(4e-4f), view.effects.noise.floor = glm::vec3(0);
  view.effects.noise.block_shift = {1, 1};
  // Red has colour alone, green luma alone.
  view.effects.noise.mix = glm::mat3(1, 0, 0, 0, 0, 1, 0, 1, 0);
  const Composite composite = compositor.render(view, linear_grey_plate());
  for (int y = 0; y < 120; y += 2)
    for (int x = 0; x < 160; x += 2) {
      const glm::vec4 first = pixel_at(composite, x, y), last = pixel_at(composite, x + 1, y + 1);
      EXPECT_FLOAT_EQ(first.r, last.r);
      EXPECT_NE(first.g, last.g);
    }
}

TYPED_TEST(SensorNoiseGl, WhatIsNotTouchedIsNotNoisier) {
  RenderScene scene = grey_wall();
  scene.mesh = square({-0.02, -0.02}, {0.02, 0.02}, 0);
  scene.transfer = unshadowed_transfer(scene.mesh, 3);
  TypeParam compositor(scene, without_glare());
  FrameView view = noisy_view();
  view.effects.defocus_px2 = 1e-9;
  const Composite composite = compositor.render(view, linear_grey_plate());
  for (int y = composite.rect.y; y < composite.rect.y + composite.rect.height; ++y)
    for (int x = composite.rect.x; x < composite.rect.x + composite.rect.width; ++x)
      if (std::abs(x - 79.5) > 10 || std::abs(y - 59.5) > 10) {
        EXPECT_EQ(pixel_at(composite, x, y), glm::vec4(0.5, 0.5, 0.5, 0));
      }
}

TYPED_TEST(SensorNoiseGl, AShadowKeepsThePlatesOwnNoiseAndGetsTheRest) {
  // Ratio r on light I: the plate's noise comes through as r^2 (a I + b), and a r I + b is wanted.
  Material black;
  black.base_color = glm::vec3(0);
  black.dielectric_f0 = 0;
  RenderScene scene = constant_scene(square({-1e-4, -1e-4}, {1e-4, 1e-4}, -10.0), black, glm::vec3(1));
  add_receiver(scene.transfer, {.min_m = {-0.4f, -0.4f}, .max_m = {0.4f, 0.4f}, .columns = 41, .rows = 41},
               [](double x, double y) { return std::max(std::abs(x), std::abs(y)) < 0.3 ? 0.4 : 1.0; });
  TypeParam compositor(scene, without_glare());
  const FrameView view = noisy_view();
  const Composite composite = compositor.render(view, linear_grey_plate());
  const std::vector<double> noise = channel(composite, 1, 0.2);
  const double expected = 3e-4 * 0.2 + 1e-5 - 0.16 * (3e-4 * 0.5 + 1e-5);
  EXPECT_NEAR(moment(noise, noise) / expected, 1, 0.05);
}

TYPED_TEST(SensorNoiseGl, ExtremesStayFinite) {
  TypeParam compositor(grey_wall(), {});
  for (const float exposure : {0.0f, 1e-6f, 1e6f}) {
    FrameView view = noisy_view();
    view.exposure = glm::vec3(exposure);
    const auto nan_plate = plate_f32([](int x, int) { return glm::vec3(x % 2 ? NAN : INFINITY); });
    for (const float value : compositor.render(view, nan_plate).rgba) ASSERT_TRUE(std::isfinite(value)) << exposure;
  }
}

TYPED_TEST(SensorNoiseGl, VignettingIsRelativeToTheTag) {
  TypeParam compositor(grey_wall(), without_glare());
  FrameView view = linear_view_from_above();
  view.camera.vignetting = {-0.3, 0.05, -0.1};
  const Composite composite = compositor.render(view, linear_grey_plate());
  const auto passed = [](double x, double y) {
    const double r2 = ((x - 79.5) * (x - 79.5) + (y - 59.5) * (y - 59.5)) / (80.0 * 80 + 60 * 60);
    return 1 + r2 * (-0.3 + r2 * (0.05 - 0.1 * r2));
  };
  for (const auto& [x, y] : {std::pair(80, 60), {0, 0}, {159, 119}, {30, 100}})
    EXPECT_NEAR(pixel_at(composite, x, y).r, 0.5 * passed(x, y), 1e-5) << x << ", " << y;
  view.camera_from_tag.translation_m = {0.1, -0.05, 0.5};  // the tag 40 px right of the middle and 20 above
  EXPECT_NEAR(pixel_at(compositor.render(view, linear_grey_plate()), 20, 100).r, 0.5 * passed(20, 100) / passed(119.5, 39.5),
              1e-5);
}

}  // namespace
}  // namespace catchlight::render::test
