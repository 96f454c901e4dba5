// The layers that a compositing package recombines: what docs/conventions.md says of them holds in every frame.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "catchlight/composite.hpp"
#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/plate.hpp"
#include "render/frame_view.hpp"
#include "render/object_layers.hpp"
#include "render/render_scene.hpp"
#include "tests/support/gl_fixture.hpp"
#include "tests/support/renderers.hpp"

namespace catchlight::render::test {
namespace {

template <typename Renderer>
using LayersGl = EachRenderer<Renderer>;
TYPED_TEST_SUITE(LayersGl, Renderers, RendererNames);

/// A glossy ball over a shadow, in a light that makes it glare.
RenderScene full_scene() {
  Material gloss;
  gloss.base_color = {0.8f, 0.4f, 0.2f};
  gloss.roughness = 0.1f;
  RenderScene scene = constant_scene(sphere(0.04, {0, 0, 0.05}), gloss, glm::vec3(1));
  scene.reflections = reflections_of([](const glm::dvec3& d) { return glm::vec3(d.z > 0.95 ? 200.0f : 0.5f); }, 32, 3);
  add_receiver(scene.transfer, {.min_m = {-0.1f, -0.1f}, .max_m = {0.1f, 0.1f}, .columns = 41, .rows = 41},
               [](double x, double y) { return 1 - 0.7 * std::exp(-(x * x + y * y) / 0.002); });
  return scene;
}

TYPED_TEST(LayersGl, RecombineToThePicture) {
  TypeParam compositor(full_scene(), {});
  FrameView view = linear_view_from_above();
  view.black = glm::vec3(0.02f);
  const PlateReader plate =
      plate_f32([](int x, int y) { return glm::vec3(0.01f * static_cast<float>(x), 0.005f * static_cast<float>(y), 0.3f); });
  const Composite composite = compositor.render(view, plate, true);
  ASSERT_TRUE(composite.layers);
  EXPECT_TRUE(composite.glare_drawn);
  EXPECT_EQ(composite.rect, (PixelRect{0, 0, 160, 120}));
  const Image recomposed = recompose(*composite.layers);
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) {
      for (int c = 0; c < 3; ++c) {
        const double sum = recomposed.pixel(x, y)[c];
        ASSERT_NEAR(pixel_at(composite, x, y)[c], sum, 1e-5 * (1 + sum)) << x << ", " << y;
      }
    }
  }
}

TYPED_TEST(LayersGl, HoldGeometry) {
  TypeParam compositor(full_scene(), {});
  const Layers layers = *compositor.render(linear_view_from_above(), linear_grey_plate(), true).layers;
  // Straight above the ball: its top is 0.5 - 0.09 m away and faces the camera (-z in the camera frame).
  EXPECT_NEAR(*layers.depth.pixel(80, 60), 0.41, 1e-3);
  EXPECT_NEAR(layers.normal.pixel(80, 60)[2], -1.0, 1e-3);
  EXPECT_GT(layers.normal.pixel(90, 60)[0], 0.3) << "camera x is picture right";
  EXPECT_EQ(layers.object.pixel(80, 60)[3], 1.0f);
  EXPECT_GT(layers.reflection.pixel(80, 60)[0], 1.0f);
  EXPECT_EQ(*layers.depth.pixel(0, 0), std::numeric_limits<float>::infinity()) << "nothing is there";
  EXPECT_EQ(layers.object.pixel(0, 0)[3], 0.0f);
  EXPECT_EQ(layers.shadow.pixel(0, 0)[0], 1.0f);
}

TYPED_TEST(LayersGl, WithNothingInSightAreThePlate) {
  TypeParam compositor(full_scene(), {});
  FrameView view = linear_view_from_above();
  view.camera_from_tag.translation_m.z = -1;
  const Composite composite = compositor.render(view, linear_grey_plate(), true);
  ASSERT_TRUE(composite.layers);
  EXPECT_NEAR(composite.layers->plate.pixel(3, 4)[1], 0.5f, 1e-6);
  EXPECT_EQ(composite.layers->object.pixel(80, 60)[3], 0.0f);
  EXPECT_EQ(*composite.layers->depth.pixel(80, 60), std::numeric_limits<float>::infinity());
  for (std::size_t i = 3; i < composite.rgba.size(); i += 4) ASSERT_EQ(composite.rgba[i], 0.0f);
}

TYPED_TEST(LayersGl, ChangeNoPixelOfThePicture) {
  TypeParam compositor(full_scene(), {});
  const Composite with = compositor.render(linear_view_from_above(), linear_grey_plate(), true),
                  without = compositor.render(linear_view_from_above(), linear_grey_plate());
  for (int y = without.rect.y; y < without.rect.y + without.rect.height; ++y) {
    for (int x = without.rect.x; x < without.rect.x + without.rect.width; ++x)
      ASSERT_EQ(pixel_at(with, x, y), pixel_at(without, x, y));
  }
}

/// Frames as lens, shutter and camera make them.
std::vector<std::pair<std::string, FrameView>> frames() {
  FrameView sharp = linear_view_from_above(), defocused = sharp, moved = sharp, both = sharp, vignetted = sharp, leaving = sharp;
  sharp.black = defocused.black = glm::vec3(0.02f);
  defocused.effects.defocus_px2 = 9;
  moved.effects.motion.shift_m = {14 * 0.5 / 200, 5 * 0.5 / 200, 0};
  both.effects = moved.effects;
  both.effects.defocus_px2 = 2;
  vignetted.effects = both.effects;
  vignetted.camera.vignetting = {-0.4, 0.1, -0.1};
  vignetted.camera.distortion = {-0.1, 0.02, 0, 0, 0, 0, 0, 0};
  leaving.effects = both.effects;
  leaving.camera_from_tag.translation_m.x = 0.19;
  return {{"sharp", sharp}, {"defocused", defocused}, {"moved", moved},
          {"both", both},   {"vignetted", vignetted}, {"leaving the picture", leaving}};
}

/// What holds in each pixel, whatever the lens and the shutter did.
void expect_conventions(const Layers& layers) {
  for (std::size_t i = 0; i < layers.depth.data.size(); ++i) {
    const float *object = &layers.object.data[4 * i], *reflection = &layers.reflection.data[3 * i];
    const float alpha = object[3], depth_m = layers.depth.data[i];
    ASSERT_GE(alpha, 0) << i;
    ASSERT_LE(alpha, 1 + 1e-5f) << i;
    for (int c = 0; c < 3; ++c) {
      ASSERT_GE(reflection[c], 0) << i;
      ASSERT_LE(reflection[c], object[c] * 1.0001f + 1e-5f) << "a part of the object, at " << i;
    }
    ASSERT_EQ(std::isfinite(depth_m), alpha >= kMinCoverage) << i;
    const float* n = &layers.normal.data[3 * i];
    ASSERT_NEAR(glm::length(glm::vec3(n[0], n[1], n[2])), alpha >= kMinCoverage ? 1 : 0, 1e-5) << i;
    if (alpha < kMinCoverage) continue;
    ASSERT_GT(depth_m, 0.41 - 1e-4) << "the ball's top, at " << i;  // its middle is 0.05 above the tag, its radius 0.04
    ASSERT_LT(depth_m, 0.49) << i;
    ASSERT_LT(n[2], 0.4) << "what is seen faces the camera, which looks up to 23 degrees past the axis: at " << i;
  }
}

TYPED_TEST(LayersGl, AreWhatTheConventionsSayHoweverTheFrameIsBlurred) {
  TypeParam compositor(full_scene(), {});
  for (const auto& [name, view] : frames()) {
    SCOPED_TRACE(name);
    expect_conventions(*compositor.render(view, linear_grey_plate(), true).layers);
  }
}

TYPED_TEST(LayersGl, OfAMirrorAreTheReflectionAndTheVeilBeforeIt) {
  // A ball of metal has no light but what it mirrors; with a black that the lens scatters, object = reflection + alpha * black.
  RenderScene scene = full_scene();
  scene.mesh.materials[0].metallic = 1;
  scene.transfer = unshadowed_transfer(scene.mesh, 3);
  TypeParam compositor(scene, {});
  for (const auto& [name, view] : frames()) {
    const Layers layers = *compositor.render(view, linear_grey_plate(), true).layers;
    double brightest = 0;
    for (std::size_t i = 0; i < layers.depth.data.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        const float mirrored = layers.reflection.data[3 * i + c],
                    veil = layers.object.data[4 * i + 3] * view.black[static_cast<int>(c)];
        brightest = std::max(brightest, double{mirrored});
        ASSERT_NEAR(layers.object.data[4 * i + c], mirrored + veil, 1e-4 * mirrored + 1e-5) << name << ", " << i;
      }
    EXPECT_GT(brightest, name == "leaving the picture" ? 0.3 : 10) << name << ": a highlight, where it is in the picture";
  }
}

TYPED_TEST(LayersGl, KeepDepthAndNormalsSharpWhereTheSharpObjectIs) {
  TypeParam compositor(full_scene(), {});
  FrameView view = linear_view_from_above();
  const Layers sharp = *compositor.render(view, linear_grey_plate(), true).layers;
  view.effects.defocus_px2 = 4;
  view.effects.motion.shift_m = {0.02, 0, 0};
  const Layers blurred = *compositor.render(view, linear_grey_plate(), true).layers;
  int inside = 0, fringe = 0;
  for (std::size_t i = 0; i < sharp.depth.data.size(); ++i) {
    if (std::isfinite(sharp.depth.data[i])) {
      ++inside;
      ASSERT_NEAR(blurred.depth.data[i], sharp.depth.data[i], 1e-5) << "but for how a card rounds, at " << i;
      for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(blurred.normal.data[3 * i + c], sharp.normal.data[3 * i + c], 1e-4) << i;
    } else {
      fringe += std::isfinite(blurred.depth.data[i]);
    }
  }
  EXPECT_GT(inside, 500);
  EXPECT_GT(fringe, 100);
}

TYPED_TEST(LayersGl, GlareOfWhatTheObjectEmitsIsMultipliedHoweverTheFrameIsBlurred) {
  // All of the object's light is its own, so `emitter_strength` multiplies all of the glare: at the blurred rim too, where the
  // emitted light is as blurred as the object's.
  RenderScene scene = constant_scene(square({-0.02, -0.02}, {0.02, 0.02}, 0), Material{}, glm::vec3(0));
  scene.mesh.materials[0].base_color = glm::vec3(0);
  scene.mesh.materials[0].emissive = glm::vec3(50);
  const auto glare_of = [&](double strength, const FrameView& view) {
    CompositorSettings settings;
    settings.glare.emitter_strength = strength;
    const Image glare = TypeParam(scene, settings).render(view, linear_grey_plate(), true).layers->glare;
    return std::accumulate(glare.data.begin(), glare.data.end(), 0.0);
  };
  for (const auto& [name, view] : frames()) {
    const double once = glare_of(1, view);
    EXPECT_GT(once, 1) << name;
    EXPECT_NEAR(glare_of(3, view) / once, 3, 0.003) << name;
  }
}

}  // namespace
}  // namespace catchlight::render::test
