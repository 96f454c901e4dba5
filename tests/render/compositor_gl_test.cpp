// The compositor as a whole, on scenes whose pictures are known in closed form.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "catchlight/color.hpp"
#include "catchlight/composite.hpp"
#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/plate.hpp"
#include "catchlight/response.hpp"
#include "render/frame_view.hpp"
#include "render/render_scene.hpp"
#include "tests/support/gl_fixture.hpp"
#include "tests/support/renderers.hpp"

namespace catchlight::render::test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

template <typename Renderer>
using CompositorGl = EachRenderer<Renderer>;
TYPED_TEST_SUITE(CompositorGl, Renderers, RendererNames);

/// llvmpipe's pow() is good to about 2e-5; a fiftieth of an 8-bit code leaves room for other drivers and rounds alike.
constexpr double kCodeTolerance = 0.02 / 255;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

Material matte(const glm::vec3& albedo) {
  Material material;
  material.base_color = albedo;
  material.dielectric_f0 = 0.0f;
  return material;
}

RenderScene matte_sphere(const glm::vec3& albedo = glm::vec3(0.5f)) {
  return constant_scene(sphere(0.05, {0, 0, 0.05}), matte(albedo), glm::vec3(1));
}

RenderScene shadow_only(double ratio) {
  RenderScene scene = constant_scene(square({-1e-4, -1e-4}, {1e-4, 1e-4}, -10.0), matte(glm::vec3(0)), glm::vec3(1));
  const auto inner = [ratio](double x, double y) { return std::max(std::abs(x), std::abs(y)) < 0.06 ? ratio : 1.0; };
  add_receiver(scene.transfer, {.min_m = {-0.1f, -0.1f}, .max_m = {0.1f, 0.1f}, .columns = 41, .rows = 41}, inner);
  return scene;
}

TYPED_TEST(CompositorGl, WhiteFurnaceShowsTheAlbedoExactly) {
  const glm::vec3 albedo(0.8f, 0.5f, 0.2f);
  TypeParam compositor(matte_sphere(albedo), {});
  const Composite composite = compositor.render(view_from_above(), plate_u8(128));
  for (const int x : {64, 70, 79, 85, 95}) {
    // A tenth of a code: llvmpipe interpolates what is constant over a small triangle to 5e-4 of it.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixel_at(composite, x, 60)[c], srgb_from_linear(albedo[c]), 0.1 / 255);
  }
}

TYPED_TEST(CompositorGl, WhiteFurnaceNeverGivesBackMoreThanCame) {
  for (const float roughness : {0.0f, 0.25f, 0.5f, 1.0f}) {
    for (const float metallic : {0.0f, 1.0f}) {
      Material material;
      material.base_color = glm::vec3(1);
      material.roughness = roughness;
      material.metallic = metallic;
      TypeParam compositor(constant_scene(sphere(0.05, {0, 0, 0}), material, glm::vec3(1)), {});
      FrameView view = view_from_above();
      view.color.transfer = TransferFunction::linear;
      const Composite composite = compositor.render(view, plate_f32([](int, int) { return glm::vec3(0); }));
      for (int x = 62; x <= 97; ++x) {
        // A white dielectric and a smooth metal give back all; a rough metal loses what would leave by a second bounce between
        // facets.
        const float value = pixel_at(composite, x, 60).x;
        EXPECT_LE(value, 1.003f) << "x " << x << " roughness " << roughness << " metallic " << metallic;
        EXPECT_GE(value, metallic == 0 || roughness == 0 ? 0.99f : 0.3f)
            << "x " << x << " roughness " << roughness << " metallic " << metallic;
      }
    }
  }
}

TYPED_TEST(CompositorGl, All256CodesSurviveDecodeAndEncode) {
  // Glare of strength 0 is drawn nowhere; a shadow of half the light in one corner makes the shader code every pixel it is asked
  // for.
  RenderScene scene = shadow_only(1.0 - 2e-6);
  TypeParam compositor(scene, {});
  const Composite composite =
      compositor.render(view_from_above(), plate_u8([](int x, int y) { return glm::ivec3((16 * y + x) % 256); }));
  int seen = 0;
  for (int y = 52; y < 68; ++y) {
    for (int x = 72; x < 88; ++x, ++seen) {
      const int code = (16 * y + x) % 256;
      if (!holds(composite, x, y)) continue;  // left to the plate
      EXPECT_EQ(std::lround(pixel_at(composite, x, y).x * 255), code);
      EXPECT_NEAR(pixel_at(composite, x, y).x, code / 255.0, kCodeTolerance);
      EXPECT_EQ(pixel_at(composite, x, y).w, 0.0f) << "a two-millionth of shadow is no change";
    }
  }
  EXPECT_EQ(seen, 256);
}

TYPED_TEST(CompositorGl, EveryTransferFunctionIsDecodedAndCodedAsStated) {
  // Half the light must come out as the code of half the light, by catchlight.hpp's own curves.
  TypeParam compositor(shadow_only(0.5), {});
  for (const auto transfer : {TransferFunction::srgb, TransferFunction::linear, TransferFunction::gamma22,
                              TransferFunction::gamma28, TransferFunction::pq, TransferFunction::hlg}) {
    FrameView view = view_from_above();
    view.color.transfer = transfer;
    for (const float code : {0.02f, 0.3f, 0.6f, 0.95f}) {
      const Composite composite = compositor.render(view, plate_f32([code](int, int) { return glm::vec3(code); }));
      const double back = linear_from_code(transfer, pixel_at(composite, 80, 60).x);
      // 1e-3 of the light: PQ's exponent of 79 magnifies float rounding most.
      EXPECT_NEAR(back / (0.5 * linear_from_code(transfer, code)), 1.0, 1e-3) << static_cast<int>(transfer) << " code " << code;
    }
  }
}

TYPED_TEST(CompositorGl, WhatNothingVirtualReachesIsMarkedUnchanged) {
  TypeParam compositor(matte_sphere(), {});
  const Composite composite = compositor.render(view_from_above(), plate_u8([](int x, int y) { return glm::ivec3(x, y, 77); }));
  const PixelRect& rect = composite.rect;
  ASSERT_FALSE(rect.empty());
  for (int y = rect.y; y < rect.y + rect.height; ++y) {
    for (int x = rect.x; x < rect.x + rect.width; ++x) {
      // The sphere's outline is 22.4 px from its centre; a pixel more is outside for certain.
      if (std::hypot(x - 79.5, y - 59.5) < 24) continue;
      const glm::vec4 pixel = pixel_at(composite, x, y);
      // GL and C++ may divide by 255 to neighbouring floats.
      EXPECT_LT(glm::distance(pixel, glm::vec4(x / 255.0f, y / 255.0f, 77 / 255.0f, 0.0f)), 1e-6f) << x << ", " << y;
      EXPECT_EQ(pixel.w, 0.0f) << x << ", " << y;
    }
  }
}

TYPED_TEST(CompositorGl, ThePlateIsAskedForOnlyWhatIsReached) {
  TypeParam compositor(matte_sphere(), without_glare());
  const PlateReader plate = plate_u8(100);
  PixelRect asked;
  const Composite composite = compositor.render(view_from_above(), [&](const PixelRect& rect) {
    asked = rect;
    return plate(rect);
  });
  EXPECT_EQ(asked, composite.rect);
  EXPECT_LT(asked.width, 60);
  EXPECT_LT(asked.height, 60);
}

TYPED_TEST(CompositorGl, ExposureScalesLinearly) {
  TypeParam compositor(matte_sphere(), without_glare());
  FrameView view = view_from_above();
  view.color.transfer = TransferFunction::linear;
  const PlateReader black = plate_f32([](int, int) { return glm::vec3(0); });
  view.exposure = {1.0f, 1.0f, 1.0f};
  const glm::vec4 once = pixel_at(compositor.render(view, black), 80, 60);
  view.exposure = {3.0f, 0.25f, 1000.0f};
  const glm::vec4 scaled = pixel_at(compositor.render(view, black), 80, 60);
  // Float plates are not clipped, so that 1000 stays 1000.
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(scaled[c] / (once[c] * view.exposure[c]), 1.0, 1e-6);
}

TYPED_TEST(CompositorGl, UnlitSurfacesShowTheirColourWhateverLightAndExposureAre) {
  Material label = matte(glm::vec3(0));
  label.unlit_color = {0.9f, 0.02f, 0.3f};
  FrameView view = view_from_above();
  for (const float radiance : {0.0f, 1.0f, 40.0f}) {
    TypeParam compositor(constant_scene(sphere(0.05, {0, 0, 0.05}), label, glm::vec3(radiance)), {});
    for (const float exposure : {0.01f, 1.0f, 7.0f}) {
      view.exposure = glm::vec3(exposure, 2 * exposure, 0.3f * exposure);
      const Composite composite = compositor.render(view, plate_u8(128));
      EXPECT_FALSE(composite.glare_drawn);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(pixel_at(composite, 80, 60)[c], srgb_from_linear(label.unlit_color[c]), 0.1 / 255) << radiance << exposure;
    }
  }
}

TYPED_TEST(CompositorGl, IntegerPlatesEndAtWhite) {
  TypeParam compositor(matte_sphere(glm::vec3(1)), without_glare());
  FrameView view = view_from_above();
  view.exposure = glm::vec3(50);
  EXPECT_EQ(pixel_at(compositor.render(view, plate_u8(10)), 80, 60), glm::vec4(1));
}

TYPED_TEST(CompositorGl, BlackLevelLiesOverObjectAndShadowAlike) {
  // Stray light in the lens: a perfectly black object shows it, and a total shadow leaves it.
  FrameView view = view_from_above();
  view.color.transfer = TransferFunction::linear;
  view.black = {0.02f, 0.03f, 0.04f};
  const PlateReader plate = plate_f32([](int, int) { return glm::vec3(0.5f); });
  TypeParam black_object(matte_sphere(glm::vec3(0)), {});
  TypeParam total_shadow(shadow_only(0.0), {});
  const Composite object = black_object.render(view, plate), shadow = total_shadow.render(view, plate);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(pixel_at(object, 80, 60)[c], view.black[c], 1e-6);
    EXPECT_NEAR(pixel_at(shadow, 80, 60)[c], view.black[c], 1e-6);
  }
}

TYPED_TEST(CompositorGl, SameInputGivesTheSameBytes) {
  RenderScene scene = matte_sphere();
  scene.mesh.materials[0].dielectric_f0 = 0.04f;
  FrameView view = view_from_above();
  view.exposure = glm::vec3(4);
  const PlateReader plate = plate_u8([](int x, int y) { return glm::ivec3(x, y, x ^ y); });
  TypeParam first(scene, {}), second(scene, {});
  const Composite a = first.render(view, plate);
  FrameView elsewhere = view;
  elsewhere.camera_from_tag.translation_m.x += 0.02;
  first.render(elsewhere, plate);
  const Composite again = first.render(view, plate), b = second.render(view, plate);
  EXPECT_EQ(a.rgba, again.rgba) << "a frame in between left something behind";
  EXPECT_EQ(a.rgba, b.rgba);
}

TYPED_TEST(CompositorGl, TheObjectsEdgeMixesByCoverageInLinearLight) {
  // A white square whose left edge wanders over the pixel of column 80 in steps that four samples can tell apart.
  const double px_m = 0.5 / 200;
  FrameView view = view_from_above();
  view.color.transfer = TransferFunction::linear;
  double last = -1;
  for (const double covered : {0.0, 0.5, 1.0}) {
    const double edge_px = 81 - covered;  // the pixel's own edges are at 80 and 81, counted from the picture's left edge
    TypeParam compositor(
        constant_scene(square({(edge_px - 80) * px_m, -0.02}, {0.02, 0.02}, 0), matte(glm::vec3(1)), glm::vec3(1)),
        without_glare());
    const float value = pixel_at(compositor.render(view, plate_f32([](int, int) { return glm::vec3(0); })), 80, 60).x;
    EXPECT_NEAR(value, covered, 1e-5);
    EXPECT_GT(value, last);
    last = value;
  }
}

TYPED_TEST(CompositorGl, ViewsWithoutTheObjectAreEmpty) {
  TypeParam compositor(matte_sphere(), {});
  const PlateReader never = [](const PixelRect&) -> Plate { throw Error("the plate must not be asked for"); };
  FrameView behind = view_from_above(-0.5), aside = view_from_above();
  aside.camera_from_tag.translation_m.x = 3;
  EXPECT_TRUE(compositor.render(behind, never).rect.empty()) << "object behind the camera";
  EXPECT_TRUE(compositor.render(aside, never).rect.empty()) << "object beside the picture";
  EXPECT_TRUE(compositor.pass_times().empty());
}

TYPED_TEST(CompositorGl, AnObjectPartlyOutOfViewStaysInThePicture) {
  TypeParam compositor(matte_sphere(), {});
  FrameView view = view_from_above();
  view.camera_from_tag.translation_m = {0.2, 0.15, 0.5};
  const Composite composite = compositor.render(view, plate_u8(20));
  ASSERT_FALSE(composite.rect.empty());
  EXPECT_EQ(composite.rect.x + composite.rect.width, 160);
  EXPECT_EQ(composite.rect.y + composite.rect.height, 120);
}

TYPED_TEST(CompositorGl, AnObjectAroundTheCameraIsCutAtTheNearPlane) {
  TypeParam compositor(constant_scene(sphere(0.3, {0, 0, 0.4}), matte(glm::vec3(0.5f)), glm::vec3(1)), {});
  const Composite composite = compositor.render(view_from_above(), plate_u8(0));
  EXPECT_EQ(composite.rect, (PixelRect{0, 0, 160, 120}));
  for (const float value : composite.rgba) EXPECT_TRUE(std::isfinite(value));
  EXPECT_NEAR(pixel_at(composite, 80, 60).x, srgb_from_linear(0.5), kCodeTolerance) << "the inside of the far wall";
}

TYPED_TEST(CompositorGl, TheReceiverIsNotSeenFromBelow) {
  TypeParam compositor(shadow_only(0.2), {});
  FrameView view = view_from_above();
  view.camera_from_tag.rotation = glm::dmat3(1.0);  // looks along +z from under the table
  EXPECT_TRUE(compositor.render(view, plate_u8(128)).rect.empty());
}

TYPED_TEST(CompositorGl, NotANumberStaysWhereItIs) {
  RenderScene scene = matte_sphere();
  scene.transfer.object[5] = glm::vec3(kNaN);
  scene.mesh.vertices[100].normal = glm::vec3(0);
  scene.mesh.vertices[200].color = glm::vec3(kNaN);
  scene.mesh.materials[0].metallic = 1;
  for (Image& level : scene.reflections.levels) level.data[0] = std::numeric_limits<float>::infinity();
  TypeParam compositor(scene, {});
  FrameView view = view_from_above();
  view.exposure = glm::vec3(10);
  const Composite composite = compositor.render(view, plate_u8(50));
  for (const float value : composite.rgba) ASSERT_TRUE(std::isfinite(value));
}

TYPED_TEST(CompositorGl, NotANumberInAFloatPlateIsKeptWhereUntouchedAndCoveredByTheObject) {
  TypeParam compositor(matte_sphere(), without_glare());
  FrameView view = view_from_above();
  view.color.transfer = TransferFunction::linear;
  const Composite composite = compositor.render(view, plate_f32([](int, int) { return glm::vec3(kNaN); }));
  EXPECT_NEAR(pixel_at(composite, 80, 60).x, 0.5, 1e-5);
  EXPECT_EQ(pixel_at(composite, 80, 60).w, 1.0f);
  EXPECT_TRUE(std::isnan(pixel_at(composite, composite.rect.x, composite.rect.y).x));
  EXPECT_EQ(pixel_at(composite, composite.rect.x, composite.rect.y).w, 0.0f);
}

TYPED_TEST(CompositorGl, PassesAreTimedByName) {
  TypeParam compositor(matte_sphere(), {});
  compositor.render(view_from_above(), plate_u8(128));
  std::vector<std::string> names;
  for (const PassTime& time : compositor.pass_times()) {
    names.push_back(time.name);
    EXPECT_GE(time.ms, 0);
  }
  EXPECT_THAT(names, ::testing::ElementsAre("light", "object", "receiver", "highlights", "plate", "composite"));
}

TYPED_TEST(CompositorGl, DataThatDoNotFitTogetherAreRefusedByName) {
  RenderScene scene = matte_sphere();
  scene.light.pop_back();
  EXPECT_THAT([&] { TypeParam(scene, {}); }, ThrowsMessage<Error>(HasSubstr("light coefficients")));
  scene = matte_sphere();
  scene.transfer.object.pop_back();
  EXPECT_THAT([&] { TypeParam(scene, {}); }, ThrowsMessage<Error>(HasSubstr("transfer coefficients")));
  scene = matte_sphere();
  scene.mesh.indices[7] = 1u << 30;
  EXPECT_THAT([&] { TypeParam(scene, {}); }, ThrowsMessage<Error>(HasSubstr("beyond the vertices")));
  scene = matte_sphere();
  scene.reflections.levels[0].height -= 1;
  EXPECT_THAT([&] { TypeParam(scene, {}); }, ThrowsMessage<Error>(HasSubstr("six square RGB faces")));
}

TYPED_TEST(CompositorGl, FramesThatMakeNoSenseAreRefusedByName) {
  TypeParam compositor(matte_sphere(), {});
  FrameView view = view_from_above();
  view.camera_from_tag.translation_m.y = kNaN;
  EXPECT_THAT([&] { compositor.render(view, plate_u8(0)); }, ThrowsMessage<Error>(HasSubstr("pose")));
  view = view_from_above();
  view.camera.width_px = 0;
  EXPECT_THAT([&] { compositor.render(view, plate_u8(0)); }, ThrowsMessage<Error>(HasSubstr("0 x 120")));
  view = view_from_above();
  const auto short_plate = [](const PixelRect& rect) { return Plate{rect, Plate::Format::rgb_u8, RawVector<std::byte>(5)}; };
  EXPECT_THAT([&] { compositor.render(view, short_plate); }, ThrowsMessage<Error>(HasSubstr("bytes, got 5")));
}

}  // namespace
}  // namespace catchlight::render::test
