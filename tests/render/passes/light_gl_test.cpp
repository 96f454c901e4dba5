// The lights split off the probe: shadows where geometry says, on the receiver and on the object, and highlights.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "catchlight/composite.hpp"
#include "catchlight/error.hpp"
#include "render/frame_view.hpp"
#include "render/render_scene.hpp"
#include "tests/support/gl_fixture.hpp"
#include "tests/support/renderers.hpp"

namespace catchlight::render::test {
namespace {

constexpr double kPi = std::numbers::pi;

template <typename Renderer>
using LightGl = EachRenderer<Renderer>;
TYPED_TEST_SUITE(LightGl, Renderers, RendererNames);

LightSample light_from(const glm::dvec3& towards, double irradiance, double spread_rad = 0) {
  return {glm::normalize(towards), glm::dvec3(irradiance), spread_rad};
}

Material matte(float albedo) {
  Material material;
  material.base_color = glm::vec3(albedo);
  material.dielectric_f0 = 0;
  return material;
}

/// A mesh over a receiver of 0.4 m, under a sky of radiance `sky` and lights.
RenderScene lit_scene(const Mesh& mesh, const Material& material, float sky, const std::vector<LightSample>& lights) {
  constexpr int kBands = 4;
  RenderScene scene = constant_scene(mesh, material, glm::vec3(sky), kBands);
  add_receiver(scene.transfer, {.min_m = {-0.2f, -0.2f}, .max_m = {0.2f, 0.2f}, .columns = 21, .rows = 21},
               [](double, double) { return 1; });
  scene.transfer.object_direct = scene.transfer.object;
  scene.transfer.receiver_direct = scene.transfer.receiver;
  scene.lights = lights;
  const ShRgb of_lights = project_to_sh(lights, kBands);
  for (std::size_t i = 0; i < of_lights.size(); ++i) scene.light[i] += of_lights[i];
  scene.rest_reflections = scene.reflections;
  return scene;
}

/// Pixel over tag (x, y) at height z: the camera looks straight down from 0.5 m with a focal length of 200 px.
glm::ivec2 pixel_over(double x, double y, double z = 0) {
  return {static_cast<int>(std::lround(79.5 + 200 * x / (0.5 - z))), static_cast<int>(std::lround(59.5 - 200 * y / (0.5 - z)))};
}

float ratio_at(const Composite& composite, const glm::dvec2& place) {
  const glm::ivec2 p = pixel_over(place.x, place.y);
  const bool drawn = p.x >= composite.rect.x && p.y >= composite.rect.y && p.x < composite.rect.x + composite.rect.width &&
                     p.y < composite.rect.y + composite.rect.height;
  return drawn ? pixel_at(composite, p.x, p.y).x / 0.5f : 1.0f;
}

TYPED_TEST(LightGl, AShadowFallsWhereTheLightThrowsIt) {
  constexpr double kHeight_m = 0.06, kHalf_m = 0.02;
  for (const glm::dvec3& towards : {glm::dvec3(0.9, 0, 1), {-1, 0.5, 1}, {0.2, -1.2, 1}}) {
    const RenderScene scene =
        lit_scene(square(glm::dvec2(-kHalf_m), glm::dvec2(kHalf_m), kHeight_m), matte(0), 0.5f, {light_from(towards, 2)});
    TypeParam compositor(scene, without_glare());
    const Composite composite = compositor.render(linear_view_from_above(), linear_grey_plate());
    const glm::dvec2 middle = -kHeight_m / towards.z * glm::dvec2(towards);
    const double of_light = 2 * glm::normalize(towards).z / kPi, in_shadow = 0.5 / (0.5 + of_light);
    EXPECT_NEAR(ratio_at(composite, middle), in_shadow, 0.01);
    for (const double side : {-1.0, 1.0}) {
      for (const glm::dvec2& axis : {glm::dvec2(side, 0), {0, side}}) {
        EXPECT_NEAR(ratio_at(composite, middle + (kHalf_m - 0.004) * axis), in_shadow, 0.01) << "1.6 px within its edge";
        EXPECT_NEAR(ratio_at(composite, middle + (kHalf_m + 0.004) * axis), 1, 0.01) << "1.6 px beyond it";
      }
    }
  }
}

TYPED_TEST(LightGl, AWideLightHasThePenumbraOfItsWidth) {
  // A strip of light from tan -0.3 to 0.3 along x over a large square whose edge is at x = 0: across the edge's shadow the
  // light falls linearly over 0.3 times the height to either side.
  constexpr double kHeight_m = 0.08;
  std::vector<LightSample> strip;
  for (int i = 0; i < 64; ++i) strip.push_back(light_from({0.8 + 0.6 * ((i + 0.5) / 64 - 0.5), 0, 1}, 1.0 / 64));
  const RenderScene scene = lit_scene(square({0, -0.1}, {0.1, 0.1}, kHeight_m), matte(0), 0.0f, strip);
  TypeParam compositor(scene, without_glare());
  const Composite composite = compositor.render(linear_view_from_above(), linear_grey_plate());
  for (const double share : {-0.8, -0.5, 0.0, 0.5, 0.8}) {
    const double x = -0.8 * kHeight_m + share * 0.3 * kHeight_m;
    EXPECT_NEAR(ratio_at(composite, {x, 0}), 0.5 - 0.5 * share, 0.06) << share;
  }
}

TYPED_TEST(LightGl, OnePartOfAnObjectShadowsAnother) {
  Mesh mesh = square({-0.08, -0.04}, {0.08, 0.04}, 0.01);
  append(mesh, square({-0.01, -0.01}, {0.01, 0.01}, 0.05));
  subdivide_long_edges(mesh, 0.18 / 24, 10000);  // as scenes are
  const RenderScene scene = lit_scene(mesh, matte(0.6f), 0.0f, {light_from({1, 0, 1}, 2)});
  TypeParam compositor(scene, without_glare());
  const Composite composite = compositor.render(linear_view_from_above(), linear_grey_plate());
  const double lit = 0.6 / kPi * 2 * std::sqrt(0.5);
  const auto floor_at = [&](double x) {
    const glm::ivec2 p = pixel_over(x, 0, 0.01);
    return pixel_at(composite, p.x, p.y).x;
  };
  EXPECT_NEAR(floor_at(-0.04), 0, 1e-3) << "the roof's shadow";
  EXPECT_NEAR(floor_at(-0.06), lit, 1e-3 * lit);
  EXPECT_NEAR(floor_at(0.05), lit, 1e-3 * lit);
}

/// A floor of `cells` x `cells` squares under a roof.
Mesh roofed_floor(int cells) {
  Mesh mesh = square({-0.01, -0.015}, {0.015, 0.01}, 0.04);
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells; ++column) {
      const glm::dvec2 low = 0.12 * glm::dvec2(column, row) / static_cast<double>(cells) - 0.06;
      append(mesh, square(low, low + 0.12 / cells, 0.01));
    }
  }
  return mesh;
}

class LightOfTrianglesGl : public GlTest {};

TEST_F(LightOfTrianglesGl, WhatIsKeptOfSmallTrianglesIsWhatThePixelsOfLargeOnesFind) {
  // Two triangles are too large to keep anything of; of 3200, most see all of a light, or nothing.
  std::vector<LightSample> lights;
  for (int i = 0; i < 48; ++i) {
    lights.push_back(light_from({0.8 * std::cos(0.7 * i) + 0.5, 0.8 * std::sin(0.7 * i), 0.4 + 0.03 * i}, 0.05, 0.05));
    lights.back().compact = i % 3 != 0;
  }
  Material plastic = matte(0.5f);
  plastic.dielectric_f0 = 0.05f, plastic.roughness = 0.4f;
  const auto draw = [&](int cells) {
    return GlCompositor(lit_scene(roofed_floor(cells), plastic, 0.1f, lights), without_glare())
        .render(linear_view_from_above(), linear_grey_plate());
  };
  const Composite looked_up = draw(1), kept = draw(40);
  ASSERT_EQ(looked_up.rect, kept.rect);
  float darkest = 1, brightest = 0;
  double sum = 0;
  for (int y = 45; y < 75; ++y) {
    for (int x = 65; x < 95; ++x) {
      const float expected = pixel_at(looked_up, x, y).x;
      const double apart = std::abs(pixel_at(kept, x, y).x / expected - 1);
      EXPECT_LT(apart, 0.02) << x << ", " << y << ": one sample's light, where a shadow's border clips a triangle";
      sum += apart / (30 * 30);
      darkest = std::min(darkest, expected), brightest = std::max(brightest, expected);
    }
  }
  EXPECT_LT(sum, 0.001) << "on the whole";
  EXPECT_LT(darkest, 0.7f * brightest) << "shadows are in sight";
}

TYPED_TEST(LightGl, ASphereHasNoAcneAndNoLeak) {
  const glm::dvec3 towards = glm::normalize(glm::dvec3(0.6, 0.3, 1)), middle(0, 0, 0.06);
  constexpr double kRadius_m = 0.05;
  const RenderScene scene = lit_scene(sphere(kRadius_m, middle, 96), matte(1), 0.0f, {light_from(towards, 1)});
  TypeParam compositor(scene, without_glare());
  const Composite composite = compositor.render(linear_view_from_above(), linear_grey_plate());
  const glm::dvec3 camera(0, 0, 0.5);
  int compared = 0;
  for (int y = 40; y < 80; ++y) {
    for (int x = 60; x < 100; ++x) {
      const glm::dvec3 ray = glm::normalize(glm::dvec3((x - 79.5) / 200, -(y - 59.5) / 200, -1));
      const glm::dvec3 away = camera - middle;
      const double b = glm::dot(ray, away), root = b * b - glm::dot(away, away) + kRadius_m * kRadius_m;
      if (root < 2e-4) continue;  // the silhouette
      const glm::dvec3 n = (camera + (-b - std::sqrt(root)) * ray - middle) / kRadius_m;
      const double n_l = glm::dot(n, towards);
      if (n_l > 0.12) {
        EXPECT_NEAR(pixel_at(composite, x, y).x, n_l / kPi, 0.02 / kPi) << x << ", " << y;
      }
      if (n_l < -0.05) {
        EXPECT_LT(pixel_at(composite, x, y).x, 1e-6) << x << ", " << y;
      }
      ++compared;
    }
  }
  EXPECT_GT(compared, 500);
}

/// GGX after Walter et al. 2007 with separate masking functions in Heitz's correlated form, written out plainly.
double ggx(double n_v, double n_l, double n_h, double alpha) {
  const auto lambda = [&](double cosine) { return (std::sqrt(1 + alpha * alpha * (1 / (cosine * cosine) - 1)) - 1) / 2; };
  const double t = n_h * n_h * (alpha * alpha - 1) + 1;
  return alpha * alpha / (kPi * t * t) / (1 + lambda(n_v) + lambda(n_l)) / (4 * n_v * n_l);
}

/// Share of the light that leaves a metal that absorbs nothing at once, by brute force over the hemisphere.
double albedo_of(double n_v, double alpha) {
  const glm::dvec3 v(std::sqrt(1 - n_v * n_v), 0, n_v);
  double sum = 0;
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i) {
    for (int k = 0; k < kSteps; ++k) {
      const double z = (i + 0.5) / kSteps, turn = 2 * kPi * (k + 0.5) / kSteps, r = std::sqrt(1 - z * z);
      const glm::dvec3 l(r * std::cos(turn), r * std::sin(turn), z);
      sum += ggx(n_v, z, glm::normalize(v + l).z, alpha) * z * 2 * kPi / (kSteps * kSteps);
    }
  }
  return sum;
}

TYPED_TEST(LightGl, RoughMetalLosesNothingInAWhiteFurnace) {
  // Light of radiance 1 from everywhere: what absorbs nothing cannot be seen against it, however rough.
  for (const float roughness : {0.05f, 0.3f, 0.6f, 1.0f}) {
    Material metal;
    metal.base_color = glm::vec3(1);
    metal.metallic = 1;
    metal.roughness = roughness;
    TypeParam compositor(constant_scene(sphere(0.05, {0, 0, 0.06}), metal, glm::vec3(1)), without_glare());
    const Composite composite = compositor.render(linear_view_from_above(), linear_grey_plate());
    for (const int x : {66, 74, 80, 86, 94}) EXPECT_NEAR(pixel_at(composite, x, 60).x, 1, 0.02) << roughness << ", " << x;
  }
}

TYPED_TEST(LightGl, AGlossySurfaceShowsAHighlight) {
  Material metal;
  metal.base_color = glm::vec3(1);
  metal.metallic = 1;
  metal.roughness = 0.5f;
  const glm::dvec3 towards = glm::normalize(glm::dvec3(0.5, 0, 1)), n(0, 0, 1);
  const RenderScene scene = lit_scene(square({-0.1, -0.1}, {0.1, 0.1}, 0.05), metal, 0.0f, {light_from(towards, 1)});
  TypeParam compositor(scene, without_glare());
  const Composite composite = compositor.render(linear_view_from_above(), linear_grey_plate());
  for (const double x : {-0.08, -0.03, 0.0, 0.04, 0.08}) {
    const glm::ivec2 p = pixel_over(x, 0, 0.05);
    const glm::dvec3 place((p.x - 79.5) / 200 * 0.45, -(p.y - 59.5) / 200 * 0.45, 0.05);
    const glm::dvec3 to_viewer = glm::normalize(glm::dvec3(0, 0, 0.5) - place), h = glm::normalize(to_viewer + towards);
    const double once = ggx(to_viewer.z, towards.z, h.z, 0.25) * towards.z, expected = once / albedo_of(to_viewer.z, 0.25);
    EXPECT_NEAR(pixel_at(composite, p.x, p.y).x, expected, 0.01 * expected) << x;
  }
}

TYPED_TEST(LightGl, AWideLightWidensTheHighlightAndKeepsItsEnergy) {
  // The same light as 64 samples without spread over a square, and as one sample with that square's spread.
  Material metal;
  metal.base_color = glm::vec3(1);
  metal.metallic = 1;
  metal.roughness = 0.4f;
  constexpr double kHalf = 0.12;
  std::vector<LightSample> many;
  for (int i = 0; i < 64; ++i)
    many.push_back(light_from({kHalf * ((i % 8 + 0.5) / 4 - 1), kHalf * ((i / 8 + 0.5) / 4 - 1), 1}, 1.0 / 64));
  const LightSample one = light_from({0, 0, 1}, 1, kHalf / std::sqrt(3.0));
  const auto row_of = [&](const std::vector<LightSample>& lights) {
    TypeParam compositor(lit_scene(square({-0.19, -0.14}, {0.19, 0.14}, 0.001), metal, 0.0f, lights), without_glare());
    const Composite composite = compositor.render(linear_view_from_above(), linear_grey_plate());
    std::vector<double> row;
    for (int x = 10; x < 150; x += 4) row.push_back(pixel_at(composite, x, 60).x);
    return row;
  };
  const std::vector<double> fine = row_of(many), coarse = row_of({one});
  const double peak = *std::ranges::max_element(fine);
  for (std::size_t i = 0; i < fine.size(); ++i) EXPECT_NEAR(coarse[i], fine[i], 0.04 * peak);
}

/// The processor looks for the shadows of a light that turns more coarsely.
class LightThatTurnsGl : public GlTest {};

TEST_F(LightThatTurnsGl, TurnsShadowsAndHighlights) {
  // The light turned by tag_from_light is the light given turned.
  const glm::dmat3 quarter(glm::dvec3(0, 1, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, 1));
  Material plastic = matte(0.5f);
  plastic.dielectric_f0 = 0.04f;
  plastic.roughness = 0.4f;
  const Mesh ball = sphere(0.03, {0, 0, 0.03});
  const LightSample light = light_from({0.8, 0.1, 1}, 2), turned_light = light_from(quarter * light.direction, 2);
  FrameView turned_view = linear_view_from_above();
  turned_view.tag_from_light = quarter;
  GlCompositor a(lit_scene(ball, plastic, 0.3f, {light}), without_glare()),
      b(lit_scene(ball, plastic, 0.3f, {turned_light}), without_glare());
  a.render(linear_view_from_above(), linear_grey_plate());  // lit from elsewhere first
  const Composite by_view = a.render(turned_view, linear_grey_plate()),
                  by_scene = b.render(linear_view_from_above(), linear_grey_plate());
  ASSERT_EQ(by_view.rect, by_scene.rect);
  for (std::size_t i = 0; i < by_view.rgba.size(); ++i) ASSERT_NEAR(by_view.rgba[i], by_scene.rgba[i], 2e-3) << i;
}

TYPED_TEST(LightGl, LightFromBelowThrowsNoShadowOnTheTable) {
  const RenderScene scene = lit_scene(square({-0.02, -0.02}, {0.02, 0.02}, 0.05), matte(0), 0.5f, {light_from({0.5, 0, -1}, 5)});
  TypeParam compositor(scene, without_glare());
  const Composite composite = compositor.render(linear_view_from_above(), linear_grey_plate());
  for (const double x : {-0.1, -0.025, 0.06}) EXPECT_NEAR(ratio_at(composite, {x, 0.05}), 1, 1e-5);
}

TYPED_TEST(LightGl, ASunOnTheHorizonIsFinite) {
  for (const double height : {0.2, 0.02, 1e-3, 0.0, -1e-3}) {
    const RenderScene scene = lit_scene(sphere(0.03, {0, 0, 0.03}), matte(0.8f), 0.5f, {light_from({-1, 0.1, height}, 20)});
    TypeParam compositor(scene, without_glare());
    const Composite composite = compositor.render(linear_view_from_above(), linear_grey_plate());
    EXPECT_TRUE(std::ranges::all_of(composite.rgba, [](float value) { return std::isfinite(value) && value >= 0; })) << height;
  }
}

TYPED_TEST(LightGl, TheLightIsWorkedOutOnlyWhenItTurns) {
  TypeParam compositor(lit_scene(sphere(0.03, {0, 0, 0.03}), matte(0.8f), 0.5f, {light_from({-1, 0.1, 1}, 2)}), without_glare());
  const auto works_on_light = [&](const FrameView& view) {
    compositor.render(view, linear_grey_plate());
    return std::ranges::any_of(compositor.pass_times(), [](const PassTime& pass) { return std::string(pass.name) == "light"; });
  };
  FrameView view = linear_view_from_above();
  EXPECT_TRUE(works_on_light(view));
  EXPECT_FALSE(works_on_light(view));
  view.camera_from_tag.translation_m.x += 0.01;
  EXPECT_FALSE(works_on_light(view)) << "the camera's motion leaves the light alone";
  view.tag_from_light = glm::dmat3(glm::dvec3(0, 1, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, 1));
  EXPECT_TRUE(works_on_light(view));
}

TYPED_TEST(LightGl, MoreLightsThanThereIsRoomForAreRefused) {
  const std::vector<LightSample> lights(kMaxLightSamples + 1, light_from({0, 0, 1}, 1));
  EXPECT_THROW(TypeParam(lit_scene(square({-0.1, -0.1}, {0.1, 0.1}, 0.05), matte(1), 1, lights), {}), Error);
}

}  // namespace
}  // namespace catchlight::render::test
