// Glare against the convolutions it approximates, and what must not change it.
#include "catchlight/composite.hpp"
#include "catchlight/image.hpp"
#include "catchlight/plate.hpp"
#include "catchlight/response.hpp"
#include "render/frame_view.hpp"
#include "render/gl_compositor.hpp"
#include "render/passes/glare/glare_pass.hpp"
#include "render/render_scene.hpp"
#include "render/settings.hpp"
#include "tests/support/gl_fixture.hpp"

#include <cmath>

namespace catchlight::render::test {
namespace {

class GlareGl : public GlTest {};

/// A glowing square of `size_m` in front of nothing; black otherwise.
RenderScene lamp(double size_m, float radiance, const glm::dvec2& center_m = {0, 0}) {
  Material glow;
  glow.base_color = glm::vec3(0);
  glow.dielectric_f0 = 0;
  glow.emissive = glm::vec3(radiance, 0.5f * radiance, 0.25f * radiance);
  return constant_scene(square(center_m - size_m / 2, center_m + size_m / 2, 0), glow, glm::vec3(0));
}

CompositorSettings only(double bloom, double streaks, int directions = 1, double rotation_deg = 0) {
  CompositorSettings settings;
  settings.glare.bloom_strength = bloom;
  settings.glare.streak_strength = streaks;
  settings.glare.streak_directions = directions;
  settings.glare.streak_rotation_deg = rotation_deg;
  return settings;
}

/// 640 x 480 from above; a pixel is 1 mm.
FrameView wide_view(double scale = 1) {
  FrameView view = view_from_above(1.0);
  view.camera = {.width_px = static_cast<int>(640 * scale),
                 .height_px = static_cast<int>(480 * scale),
                 .fx_px = 1000 * scale,
                 .fy_px = 1000 * scale,
                 .cx_px = 320 * scale - 0.5,
                 .cy_px = 240 * scale - 0.5,
                 .distortion = {}};
  view.color.transfer = TransferFunction::linear;
  return view;
}

const PlateReader kBlackPlate = plate_f32([](int, int) { return glm::vec3(0); });

Image glare_layer(const RenderScene& scene, const CompositorSettings& settings, const FrameView& view) {
  Composite composite = GlCompositor(scene, settings).render(view, kBlackPlate, true);
  return std::move(composite.layers->glare);
}

double energy(const Image& image, int channel = 0) {
  double sum = 0;
  for (std::size_t i = static_cast<std::size_t>(channel); i < image.data.size(); i += 3) sum += image.data[i];
  return sum;
}

TEST_F(GlareGl, NothingGlaresThatTheSensorCanHold) {
  FrameView view = wide_view();
  view.exposure = glm::vec3(1);
  EXPECT_FALSE(GlCompositor(lamp(0.05, 0.999f), {}).render(view, kBlackPlate).glare_drawn);
  EXPECT_TRUE(GlCompositor(lamp(0.05, 1.5f), {}).render(view, kBlackPlate).glare_drawn);
  view.exposure = glm::vec3(0.1f);
  EXPECT_FALSE(GlCompositor(lamp(0.05, 1.5f), {}).render(view, kBlackPlate).glare_drawn) << "exposure decides, not radiance";
  EXPECT_FALSE(GlCompositor(lamp(0.05, 100.0f), without_glare()).render(wide_view(), kBlackPlate).glare_drawn);
}

TEST_F(GlareGl, GlareReachesBeyondTheObjectAndKeepsItsColour) {
  const Image glare = glare_layer(lamp(0.01, 100), only(0.1, 0), wide_view());
  const float* beside = glare.pixel(340, 240);
  EXPECT_GT(beside[0], 0.005f) << "15 px beside a lamp of 10 px";
  EXPECT_NEAR(beside[1] / beside[0], 0.5, 0.01);
  EXPECT_NEAR(beside[2] / beside[0], 0.25, 0.01);
}

TEST_F(GlareGl, EnergyIsTheExcessTimesTheStrength) {
  // 100 pixels of 100, compressed by 100 / brightest at most.
  constexpr double kExcess = 100 * 100;
  EXPECT_NEAR(energy(glare_layer(lamp(0.01, 100), only(0.08, 0), wide_view())) / (0.08 * kExcess), 1.0, 0.01);
  for (const int directions : {1, 2, 4, 6}) {
    EXPECT_NEAR(energy(glare_layer(lamp(0.01, 100), only(0, 0.06, directions, 45), wide_view())) / (0.06 * kExcess), 1.0, 0.01)
        << directions;
  }
}

TEST_F(GlareGl, EnergyStaysWhileAHighlightMovesWithinAPixel) {
  // Three pixels of lamp, moved by tenths of a pixel: what may vary is the sampling of its edges (four samples), not the glare.
  double low = 1e9, high = 0;
  for (int i = 0; i < 10; ++i) {
    const glm::dvec2 shift(i * 1e-4, i * 0.7e-4);
    const RenderScene scene = lamp(0.003, 100, shift);
    const Composite composite = GlCompositor(scene, only(0.1, 0.1, 4, 45)).render(wide_view(), kBlackPlate, true);
    double drawn = 0;
    for (std::size_t p = 0; p < composite.layers->object.data.size(); p += 4) drawn += composite.layers->object.data[p];
    const double ratio = energy(composite.layers->glare) / drawn;
    low = std::min(low, ratio);
    high = std::max(high, ratio);
  }
  EXPECT_LT(high / low, 1.005);
}

TEST_F(GlareGl, StreakFollowsItsClosedForm) {
  // Along the streak the glare of a lamp is a^k per pixel; ratios of pixels 2 apart are a^2 (half resolution), whatever the lamp.
  const Image glare = glare_layer(lamp(0.004, 1000), only(0, 0.06, 1, 0), wide_view());
  for (int x = 340; x < 420; x += 10) {
    double near = 0, far = 0;  // across the streak, so that its width does not matter
    for (int y = 225; y < 255; ++y) {
      near += glare.pixel(x, y)[0];
      far += glare.pixel(x + 10, y)[0];
    }
    EXPECT_NEAR(std::pow(far / near, 0.1), 0.92, 0.002) << "at " << x;
  }
  double behind = 0;
  for (int y = 200; y < 280; ++y) behind += glare.pixel(300, y)[0];
  EXPECT_EQ(behind, 0) << "one direction is one-sided";
}

TEST_F(GlareGl, DirectionsTurnWithTheRotation) {
  // 90 degrees points down the picture (rows grow downwards).
  const Image glare = glare_layer(lamp(0.004, 1000), only(0, 0.06, 1, 90), wide_view());
  EXPECT_GT(glare.pixel(320, 280)[0], 0.001f);
  EXPECT_EQ(glare.pixel(320, 200)[0], 0.0f);
  EXPECT_EQ(glare.pixel(360, 240)[0], 0.0f);
}

TEST_F(GlareGl, TheSameSceneGlaresAlikeAtTwiceTheResolution) {
  // Radiance at the same place of the picture: twice the pixels hold each a quarter of the light of the lamp's image.
  const RenderScene scene = lamp(0.02, 100);
  const Image small = glare_layer(scene, only(0, 0.06, 4, 45), wide_view(1)),
              large = glare_layer(scene, only(0, 0.06, 4, 45), wide_view(2));
  for (const int d : {20, 40, 60}) {
    double a = 0, b = 0;
    for (int i = -8; i <= 8; ++i) a += small.pixel(320 + d + i, 240 + d - i)[0];
    for (int i = -8; i <= 8; ++i) {
      for (int k = 0; k < 4; ++k) b += large.pixel(2 * (320 + d + i) + k % 2, 2 * (240 + d - i) + k / 2)[0] / 4;
    }
    EXPECT_NEAR(b / a, 1.0, 0.01) << d;
  }
}

TEST_F(GlareGl, AnInfiniteHighlightDoesNotSpreadInfinity) {
  const Image glare = glare_layer(lamp(0.01, 1e30f), only(0.1, 0.1), wide_view());
  for (const float value : glare.data) ASSERT_TRUE(std::isfinite(value));
}

}  // namespace
}  // namespace catchlight::render::test
