// The glare of an aperture in the composite: the same as computed on the CPU from the object's layer.
#include <cmath>

#include "catchlight/composite.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "catchlight/plate.hpp"
#include "catchlight/response.hpp"
#include "render/frame_view.hpp"
#include "render/gl_compositor.hpp"
#include "render/glare/fft_glare.hpp"
#include "render/render_scene.hpp"
#include "render/settings.hpp"
#include "tests/support/gl_fixture.hpp"

namespace catchlight::render::test {
namespace {

class ApertureGlareGl : public GlTest {};

/// A glowing square of 4 mm, 2 px wide in linear_view_from_above(1.0).
RenderScene lamp(float radiance) {
  Material glow;
  glow.base_color = glm::vec3(0);
  glow.dielectric_f0 = 0;
  glow.emissive = glm::vec3(radiance, 0.5f * radiance, 0.25f * radiance);
  return constant_scene(square({-0.002, -0.002}, {0.002, 0.002}, 0), glow, glm::vec3(0));
}

CompositorSettings with_blades() {
  CompositorSettings settings;
  settings.glare.method = GlareMethod::fft;
  settings.glare.aperture = "blades:6";
  settings.glare.aperture_mm = 0.2;
  return settings;
}

FrameView black_view() {
  FrameView view = view_from_above(1.0);
  view.color.transfer = TransferFunction::linear;
  return view;
}

const PlateReader kBlackPlate = plate_f32([](int, int) { return glm::vec3(0); });

TEST_F(ApertureGlareGl, NothingGlaresThatTheSensorCanHold) {
  EXPECT_FALSE(GlCompositor(lamp(0.999f), with_blades()).render(black_view(), kBlackPlate).glare_drawn);
  EXPECT_TRUE(GlCompositor(lamp(100), with_blades()).render(black_view(), kBlackPlate).glare_drawn);
}

TEST_F(ApertureGlareGl, IsWhatTheObjectsLayerGivesOnTheCpu) {
  const FrameView view = black_view();
  const Composite composite = GlCompositor(lamp(1000), with_blades()).render(view, kBlackPlate, true);
  const GlareSettings settings = with_blades().glare;
  const int width = view.camera.width_px, height = view.camera.height_px;
  const Image excess = excess_of(composite.layers->object, {0, 0, width, height}, width, height, settings).value();
  const Image expected = FftGlare(settings).spread(excess, view.camera);
  double brightest = 0;
  for (std::size_t i = 0; i < expected.data.size(); ++i) {
    ASSERT_NEAR(composite.layers->glare.data[i], expected.data[i], 2e-4) << i;
    brightest = std::max(brightest, static_cast<double>(expected.data[i]));
  }
  EXPECT_GT(brightest, 1);
}

TEST_F(ApertureGlareGl, ChangesOnlyTheFramesPixelsThatItReaches) {
  const FrameView view = black_view();
  const Composite all = GlCompositor(lamp(1000), with_blades()).render(view, kBlackPlate, true);
  const Composite part = GlCompositor(lamp(1000), with_blades()).render(view, kBlackPlate);
  EXPECT_EQ(part.rect, unite(part.rect, part.glare_rect));
  for (int y = 0; y < view.camera.height_px; ++y)
    for (int x = 0; x < view.camera.width_px; ++x) {
      const bool within =
          x >= part.rect.x && y >= part.rect.y && x < part.rect.x + part.rect.width && y < part.rect.y + part.rect.height;
      if (within)
        ASSERT_EQ(pixel_at(part, x, y), pixel_at(all, x, y)) << x << ' ' << y;
      else
        ASSERT_EQ(all.layers->glare.pixel(x, y)[0], 0.0f) << x << ' ' << y;
    }
}

TEST_F(ApertureGlareGl, RefusesAnApertureThatIsNotThereOnlyWhereItGlares) {
  CompositorSettings settings = with_blades();
  settings.glare.aperture = "no such file.png";
  EXPECT_THROW(GlCompositor(lamp(1), settings), Error);
  settings.glare.enabled = false;
  EXPECT_NO_THROW(GlCompositor(lamp(1), settings));
}

}  // namespace
}  // namespace catchlight::render::test
