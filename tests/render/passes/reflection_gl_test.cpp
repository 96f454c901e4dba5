// Reflections against a ray tracer of one sphere, and the directions they come from.
#include <cmath>

#include "catchlight/composite.hpp"
#include "catchlight/plate.hpp"
#include "catchlight/response.hpp"
#include "catchlight/rigid_transform.hpp"
#include "render/frame_view.hpp"
#include "render/render_scene.hpp"
#include "render/settings.hpp"
#include "tests/support/gl_fixture.hpp"
#include "tests/support/renderers.hpp"

namespace catchlight::render::test {
namespace {

template <typename Renderer>
using ReflectionGl = EachRenderer<Renderer>;
TYPED_TEST_SUITE(ReflectionGl, Renderers, RendererNames);

constexpr double kRadius_m = 0.1;

/// A mirror (F0 = 1: nothing depends on the angle) in surroundings that are never 0.
RenderScene mirror_sphere(const std::function<glm::vec3(const glm::dvec3&)>& radiance, int face_size = 128, int rings = 96) {
  Material mirror;
  mirror.base_color = glm::vec3(1);
  mirror.metallic = 1;
  mirror.roughness = 0;
  RenderScene scene = constant_scene(sphere(kRadius_m, {0, 0, 0}, rings), mirror, glm::vec3(0));
  scene.reflections = reflections_of(radiance, face_size);
  return scene;
}

FrameView linear_view(double height_m) {
  FrameView view = view_from_above(height_m);
  view.color.transfer = TransferFunction::linear;
  return view;
}

const PlateReader kBlackPlate = plate_f32([](int, int) { return glm::vec3(0); });

/// What the sphere mirrors along the ray through pixel (x, y): no GL, no mesh.
std::optional<glm::dvec3> mirrored_direction(const FrameView& view, double x, double y) {
  const RigidTransform tag_from_camera = inverse(view.camera_from_tag);
  const glm::dvec3 ray_camera((x - view.camera.cx_px) / view.camera.fx_px, (y - view.camera.cy_px) / view.camera.fy_px, 1);
  const glm::dvec3 ray = glm::normalize(tag_from_camera.rotation * ray_camera), eye = tag_from_camera.translation_m;
  const double b = glm::dot(ray, eye), discriminant = b * b - glm::dot(eye, eye) + kRadius_m * kRadius_m;
  if (discriminant < 0) return {};
  return glm::reflect(ray, glm::normalize(eye + ray * (-b - std::sqrt(discriminant))));
}

TYPED_TEST(ReflectionGl, MirrorSphereShowsWhatARayTracerSees) {
  const auto radiance = [](const glm::dvec3& d) { return glm::vec3(1.5 + d.x + 0.3 * d.y, 1.5 + d.y * d.z, 1.5 + d.z); };
  TypeParam compositor(mirror_sphere(radiance), without_glare());
  const FrameView view = linear_view(0.5);
  const Composite composite = compositor.render(view, kBlackPlate);
  int compared = 0;
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) {
      // Up to the rim (41 px), where the reflection turns through half the room within a pixel.
      if (std::hypot(x - 79.5, y - 59.5) > 38) continue;
      const glm::vec3 expected = radiance(*mirrored_direction(view, x, y));
      // Texels are 0.7 degrees wide and normals interpolated over 1.9 degrees: 0.01 of radiances that change by 2 over 180.
      EXPECT_LT(glm::distance(glm::vec3(pixel_at(composite, x, y)), expected), 0.01f) << x << ", " << y;
      ++compared;
    }
  }
  EXPECT_GT(compared, 4400);
}

TYPED_TEST(ReflectionGl, APixelAveragesTheFootprintOfACurvedMirror) {
  // Surroundings too fine for one sample a pixel: the average over 16 x 16 rays a pixel is the truth.
  const auto stripes = [](const glm::dvec3& d) { return glm::vec3(1 + 0.9 * std::sin(10 * d.x)); };
  TypeParam compositor(mirror_sphere(stripes), without_glare());
  const FrameView view = linear_view(1.5);
  const Composite composite = compositor.render(view, kBlackPlate);
  double error = 0, one_ray_error = 0;
  int count = 0;
  for (int y = 51; y <= 68; ++y) {
    for (int x = 71; x <= 88; ++x) {
      if (std::hypot(x - 79.5, y - 59.5) > 9) continue;
      double truth = 0;
      for (int i = 0; i < 256; ++i)
        truth += stripes(*mirrored_direction(view, x + (i % 16 - 7.5) / 16, y + (i / 16 - 7.5) / 16)).x / 256;
      error += std::abs(pixel_at(composite, x, y).x - truth);
      one_ray_error += std::abs(stripes(*mirrored_direction(view, x, y)).x - truth);
      ++count;
    }
  }
  ASSERT_GT(count, 200);
  EXPECT_LT(error / count, 0.4 * one_ray_error / count)
      << "mean error " << error / count << ", by one ray " << one_ray_error / count;
}

/// Column and row of the picture's brightest pixel, relative to the sphere's centre.
glm::ivec2 brightest_side(const Composite& composite) {
  glm::ivec2 best(0);
  float peak = -1;
  for (int y = composite.rect.y; y < composite.rect.y + composite.rect.height; ++y) {
    for (int x = composite.rect.x; x < composite.rect.x + composite.rect.width; ++x) {
      const float value = pixel_at(composite, x, y).x;
      if (value > peak) {
        peak = value;
        best = {x, y};
      }
    }
  }
  return best - glm::ivec2(80, 60);
}

std::function<glm::vec3(const glm::dvec3&)> lamp_at(const glm::dvec3& axis) {
  return [axis](const glm::dvec3& d) { return glm::vec3(glm::dot(d, axis) > 0.97 ? 1.0f : 0.0f); };
}

TYPED_TEST(ReflectionGl, ALampOnEachAxisShowsOnItsSide) {
  // Seen from above: tag x is right, tag y is up, tag z comes towards the camera.
  const auto side = [&](const glm::dvec3& axis) {
    return brightest_side(TypeParam(mirror_sphere(lamp_at(axis)), without_glare()).render(linear_view(0.5), kBlackPlate));
  };
  EXPECT_GT(side({1, 0, 0}).x, 15);
  EXPECT_LT(side({-1, 0, 0}).x, -15);
  EXPECT_LT(side({0, 1, 0}).y, -15);
  EXPECT_GT(side({0, -1, 0}).y, 15);
  EXPECT_LT(glm::length(glm::vec2(side({0, 0, 1}))), 8);
}

TYPED_TEST(ReflectionGl, DiffuseLightComesFromTheLampsSideToo) {
  RenderScene scene = constant_scene(sphere(kRadius_m, {0, 0, 0}), Material{}, glm::vec3(0));
  for (const glm::dvec3& axis : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, -1, 0)}) {
    std::vector<float> y(9);
    evaluate_sh(axis, 3, y);
    for (std::size_t i = 0; i < 9; ++i) scene.light[i] = glm::vec3(y[i]);
    const glm::ivec2 side = brightest_side(TypeParam(scene, without_glare()).render(linear_view(0.5), kBlackPlate));
    EXPECT_GT(glm::dot(glm::dvec2(side), glm::dvec2(axis.x, -axis.y)), 15) << axis.x << " " << axis.y;
  }
}

TYPED_TEST(ReflectionGl, ATurnedLightTurnsReflectionAndDiffuseAlike) {
  // The probe's lamp is on +x; turned by 90 degrees about z it stands on +y, which is up in the picture.
  RenderScene scene = mirror_sphere(lamp_at({1, 0, 0}));
  std::vector<float> y(9);
  evaluate_sh({1, 0, 0}, 3, y);
  for (std::size_t i = 0; i < 9; ++i) scene.light[i] = glm::vec3(y[i]);
  FrameView view = linear_view(0.5);
  view.tag_from_light = glm::dmat3(0, 1, 0, -1, 0, 0, 0, 0, 1);
  EXPECT_LT(brightest_side(TypeParam(scene, without_glare()).render(view, kBlackPlate)).y, -15);
  scene.mesh.materials[0] = Material{};
  scene.transfer = unshadowed_transfer(scene.mesh, 3);
  scene.reflections.levels.clear();
  EXPECT_LT(brightest_side(TypeParam(scene, without_glare()).render(view, kBlackPlate)).y, -15);
}

TYPED_TEST(ReflectionGl, RoughnessChoosesTheLevel) {
  RenderScene scene = mirror_sphere([](const glm::dvec3&) { return glm::vec3(1); });
  scene.reflections = reflections_of([](const glm::dvec3&) { return glm::vec3(0); }, 16, 5);
  for (std::size_t k = 0; k < 5; ++k)
    std::fill(scene.reflections.levels[k].data.begin(), scene.reflections.levels[k].data.end(), 1.0f + static_cast<float>(k));
  CompositorSettings settings = without_glare();
  settings.reflection_rays = 0;  // the whole lobe is read from the probe
  for (const int step : {0, 1, 2, 3, 4}) {
    scene.mesh.materials[0].roughness = static_cast<float>(step) / 4;
    const float value = pixel_at(TypeParam(scene, settings).render(linear_view(0.5), kBlackPlate), 80, 60).x;
    EXPECT_NEAR(value, 1 + step, 1e-4 * (1 + step)) << "a white metal sends back all that its lobe meets";
  }
}

TYPED_TEST(ReflectionGl, APolishedSurfaceHasNoHalo) {
  // Variances of lobes add: of the first level's lobe, alpha = 1/16, a roughness r below it mixes in r^4 / alpha^2.
  RenderScene scene = mirror_sphere([](const glm::dvec3&) { return glm::vec3(0); });
  scene.reflections = reflections_of([](const glm::dvec3&) { return glm::vec3(0); }, 16, 5);
  for (std::size_t k = 1; k < 5; ++k)
    std::fill(scene.reflections.levels[k].data.begin(), scene.reflections.levels[k].data.end(), 1.0f);
  CompositorSettings settings = without_glare();
  settings.reflection_rays = 0;
  for (const double roughness : {0.02, 0.05, 0.1, 0.2}) {
    scene.mesh.materials[0].roughness = static_cast<float>(roughness);
    const double value = pixel_at(TypeParam(scene, settings).render(linear_view(0.5), kBlackPlate), 80, 60).x;
    EXPECT_NEAR(value, std::pow(roughness * 4, 4), 0.01) << "hardware mixes levels in steps of 1/256; roughness " << roughness;
  }
}

TYPED_TEST(ReflectionGl, LevelsOfAnySizeAreAccepted) {
  RenderScene scene = mirror_sphere([](const glm::dvec3&) { return glm::vec3(1); });
  scene.reflections.levels.clear();
  for (const int size : {12, 12, 12, 5, 1, 1, 1})
    scene.reflections.levels.push_back(reflections_of([](const glm::dvec3&) { return glm::vec3(2); }, size).levels[0]);
  scene.mesh.materials[0].roughness = 0.1f;
  EXPECT_NEAR(pixel_at(TypeParam(scene, without_glare()).render(linear_view(0.5), kBlackPlate), 80, 60).x, 2.0, 0.02);
}

}  // namespace
}  // namespace catchlight::render::test
