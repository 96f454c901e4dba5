// A picture taken apart by its lights, and put together again.
#include "render/light_shares.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "render/cpu/cpu_compositor.hpp"
#include "render/transfer/transfer.hpp"
#include "tests/support/shapes.hpp"

namespace catchlight::render {
namespace {

constexpr int kBands = 3;

ReflectionMap sky(float radiance) {
  ReflectionMap map;
  for (int level = 0; level < 4; ++level) {
    Image faces(16 >> level, 6 * (16 >> level));
    std::ranges::fill(faces.data, radiance);
    map.levels.push_back(std::move(faces));
  }
  return map;
}

/// A ball beside a box on the receiver, under a grey sky and by two lamps.
RenderScene lit_scene() {
  Mesh mesh = sphere({-0.03f, 0, 0.04f}, 0.03f, 12);
  append(mesh, box({0.02f, -0.02f, 0}, {0.06f, 0.03f, 0.05f}));
  for (Material& material : mesh.materials) material.base_color = {0.7f, 0.5f, 0.3f}, material.roughness = 0.6f;
  RenderScene scene;
  scene.transfer = bake_transfer(mesh, receiver_grid_for(mesh, 9), {.bands = kBands, .rays = 64, .bounces = 1}, {});
  scene.lights = {{glm::normalize(glm::dvec3(0.5, 0.3, 1)), {1, 0.9, 0.7}, 0.02},
                  {glm::normalize(glm::dvec3(-1, 0.1, 0.6)), {0.5, 0.6, 0.9}, 0.02}};
  scene.light = project_to_sh(scene.lights, kBands);
  scene.light[0] += glm::vec3(0.3f * std::sqrt(4 * glm::pi<float>()));  // radiance 0.3 from everywhere
  scene.reflections = scene.rest_reflections = sky(0.3f);
  scene.mesh = std::move(mesh);
  return scene;
}

FrameView view_from_above() {
  FrameView view;
  view.camera = {.width_px = 80, .height_px = 60, .fx_px = 100, .fy_px = 100, .cx_px = 39.5, .cy_px = 29.5};
  view.camera_from_tag.rotation = glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1);
  view.camera_from_tag.translation_m = {0, 0, 0.3};
  view.black = glm::vec3(0.01f);
  return view;
}

Plate grey_plate(const PixelRect& rect) {
  Plate plate{rect, Plate::Format::rgb_u8, RawVector<std::byte>(3 * static_cast<std::size_t>(rect.width) * rect.height)};
  std::ranges::fill(plate.pixels, std::byte{150});
  return plate;
}

Image drawn(const RenderScene& scene, const FrameView& view, const glm::dvec3& share) {
  const CompositorSettings settings = settings_alone({});
  return light_of(*CpuCompositor(scene, settings).render(view, grey_plate, true).layers, share);
}

Image drawn_alone(const RenderScene& scene, std::span<const LightSample> lights) {
  return drawn(lit_alone(scene, lights), view_alone(view_from_above()), plane_share(scene, lights, glm::dmat3(1.0)));
}

/// The same picture but along shadows' edges, whose texels lie otherwise in the shadows of other lights.
void expect_same(const Image& picture, const Image& expected) {
  double sum = 0;
  std::size_t apart = 0;
  for (std::size_t i = 0; i < picture.data.size(); ++i) {
    const double difference = std::abs(picture.data[i] - expected.data[i]);
    sum += difference;
    apart += difference > 5e-3;
  }
  const auto count = static_cast<double>(picture.data.size());
  EXPECT_LT(sum / count, 1e-3) << "of values up to 0.5";
  EXPECT_LT(static_cast<double>(apart) / count, 0.05);
}

Image combined(Image a, const Image& b, float factor) {
  for (std::size_t i = 0; i < a.data.size(); ++i) a.data[i] += factor * b.data[i];
  return a;
}

TEST(LightShares, TwoLightsAddWhatEachAddsAlone) {
  const RenderScene scene = lit_scene();
  const std::span<const LightSample> lights = scene.lights;
  const Image both = drawn_alone(scene, lights), one = drawn_alone(scene, lights.first(1)),
              other = drawn_alone(scene, lights.subspan(1));
  expect_same(combined(one, other, 1), both);
  EXPECT_GT(*std::ranges::max_element(both.data), 0.1);
}

TEST(LightShares, WhatTheLightsLeaveIsTheSky) {
  const RenderScene scene = lit_scene();
  RenderScene unlit = scene;
  unlit.lights.clear();
  const ShRgb lamps = project_to_sh(scene.lights, kBands);
  for (std::size_t i = 0; i < lamps.size(); ++i) unlit.light[i] -= lamps[i];
  const Image whole = drawn(scene, view_from_above(), glm::dvec3(1.0)), lights = drawn_alone(scene, scene.lights),
              rest = drawn(unlit, view_from_above(), 1.0 - plane_share(scene, scene.lights, glm::dmat3(1.0)));
  expect_same(combined(whole, lights, -1), rest);
}

TEST(LightShares, ALampOverTheReceiverGivesItsClosedForm) {
  RenderScene scene = lit_scene();
  scene.lights = {{{0, 0, 1}, {1, 2, 0}, 0}};
  scene.light = project_to_sh(scene.lights, kBands);
  scene.light[0] += glm::vec3(0.3f * std::sqrt(4 * glm::pi<float>()));
  const glm::dvec3 share = plane_share(scene, scene.lights, glm::dmat3(1.0));
  for (int c = 0; c < 3; ++c) {
    const double lamp = scene.lights[0].irradiance[c] / glm::pi<double>();
    EXPECT_NEAR(share[c], lamp / (lamp + 0.3), 1e-3) << c;
  }
}

TEST(LightShares, ALampTurnsWithTheLight) {
  const RenderScene scene = lit_scene();
  const glm::dmat3 upside_down(1, 0, 0, 0, -1, 0, 0, 0, -1);
  EXPECT_GT(plane_share(scene, scene.lights, glm::dmat3(1.0)).x, 0.2);
  EXPECT_EQ(plane_share(scene, scene.lights, upside_down), glm::dvec3(0.0)) << "it shines from below";
}

TEST(LightShares, AloneNothingElseShines) {
  RenderScene scene = lit_scene();
  for (Material& material : scene.mesh.materials) material.emissive = {1, 1, 1}, material.unlit_color = {0.1f, 0, 0};
  const Image nothing = drawn_alone(scene, {});
  EXPECT_TRUE(std::ranges::all_of(nothing.data, [](float value) { return value == 0; }));
}

}  // namespace
}  // namespace catchlight::render
