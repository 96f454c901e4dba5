// The shadow on the receiving plane.
#include <cmath>

#include "catchlight/composite.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/plate.hpp"
#include "catchlight/response.hpp"
#include "render/frame_view.hpp"
#include "render/render_scene.hpp"
#include "tests/support/gl_fixture.hpp"
#include "tests/support/renderers.hpp"

namespace catchlight::render::test {
namespace {

template <typename Renderer>
using ReceiverGl = EachRenderer<Renderer>;
TYPED_TEST_SUITE(ReceiverGl, Renderers, RendererNames);

/// Nothing but a receiver of 0.2 m with 41 x 41 points; the object is a black speck far below.
RenderScene receiver_scene(const std::function<double(double, double)>& ratio) {
  RenderScene scene = constant_scene(square({-1e-4, -1e-4}, {1e-4, 1e-4}, -10), Material{}, glm::vec3(1));
  scene.mesh.materials[0].base_color = glm::vec3(0);
  add_receiver(scene.transfer, {.min_m = {-0.1f, -0.1f}, .max_m = {0.1f, 0.1f}, .columns = 41, .rows = 41}, ratio);
  return scene;
}

/// Tag x, y (metres) under the centre of pixel (x, y): the camera looks straight down from 0.5 m with a focal length of 200 px.
glm::dvec2 under_pixel(int x, int y) {
  return {(x - 79.5) * 0.5 / 200, -(y - 59.5) * 0.5 / 200};
}

TYPED_TEST(ReceiverGl, PlateIsMultipliedByTheRatioWhereItLies) {
  // A linear ramp passes through the B-spline unchanged; x and y differ, so that no mirroring goes unnoticed.
  const auto ramp = [](double x, double y) { return 0.6 + 3 * x + 1.5 * y; };
  TypeParam compositor(receiver_scene(ramp), {});
  const Composite composite = compositor.render(linear_view_from_above(), linear_grey_plate());
  for (int y = 30; y < 90; y += 7) {
    for (int x = 50; x < 110; x += 7) {
      const glm::dvec2 p = under_pixel(x, y);
      EXPECT_NEAR(pixel_at(composite, x, y).x, 0.5 * ramp(p.x, p.y), 1e-4) << x << ", " << y;
    }
  }
}

TYPED_TEST(ReceiverGl, TheGridsEndIsNotSeen) {
  // Even where the transfer claims half the light at the very rim, the picture goes over to the plate in small steps.
  TypeParam compositor(receiver_scene([](double, double) { return 0.5; }), {});
  const Composite composite = compositor.render(linear_view_from_above(), linear_grey_plate());
  float last = 0.5f, largest_step = 0;
  for (int x = composite.rect.x; x <= 80; ++x) {
    const float value = pixel_at(composite, x, 60).x;
    largest_step = std::max(largest_step, std::abs(value - last));
    last = value;
  }
  EXPECT_NEAR(last, 0.25, 1e-5);
  EXPECT_LT(largest_step, 0.08f) << "three points of 2 px: 0.25 over 6 px";
}

TYPED_TEST(ReceiverGl, AClippedPlateIsAsBrightAsTheReceiverMustBe) {
  // Twice the sensor's white in truth: a shadow that leaves 0.4 of it shows 0.8, one that leaves 0.6 does not show.
  FrameView view = linear_view_from_above();
  view.receiver_light = glm::vec3(2, 2, 0.5f);
  for (const double left : {0.4, 0.6}) {
    TypeParam compositor(receiver_scene([left](double, double) { return left; }), without_glare());
    const glm::vec4 clipped = pixel_at(compositor.render(view, plate_u8(255)), 80, 60);
    EXPECT_NEAR(clipped.x, std::min(2 * left, 1.0), 1e-3) << left;
    EXPECT_NEAR(clipped.z, left, 1e-3) << "never darker than it shows";
    EXPECT_NEAR(pixel_at(compositor.render(view, plate_u8(200)), 80, 60).x, left * 200 / 255, 1e-3) << "not clipped: as it shows";
  }
  view.receiver_light = glm::vec3(0);
  TypeParam compositor(receiver_scene([](double, double) { return 0.4; }), without_glare());
  EXPECT_NEAR(pixel_at(compositor.render(view, plate_u8(255)), 80, 60).x, 0.4, 1e-3) << "not known";
}

/// A camera's logarithmic curve: eight stops below white and three above.
std::shared_ptr<const ResponseCurve> logarithmic_curve() {
  ResponseCurve::Tables tables;
  for (auto& table : tables)
    for (int code = 0; code < 256; ++code) table.push_back(static_cast<float>(std::exp2(11.0 * code / 255 - 8) - std::exp2(-8)));
  return std::make_shared<ResponseCurve>(tables);
}

TYPED_TEST(ReceiverGl, LightAboveReferenceWhiteIsNotClippedWhereCodesGoOn) {
  // Only the last codes hide light. Half again as bright as white is what it is in PQ, HLG and a logarithmic curve, however much
  // brighter white paper would be there: a tenth of it in shadow is a tenth less, and no bright rim.
  FrameView view = linear_view_from_above();
  view.receiver_light = glm::vec3(3);
  TypeParam compositor(receiver_scene([](double, double) { return 0.9; }), without_glare());
  const std::vector<CameraResponse> responses{
      {TransferFunction::pq, {}}, {TransferFunction::hlg, {}}, {TransferFunction::srgb, logarithmic_curve()}};
  for (std::size_t i = 0; i < responses.size(); ++i) {
    static_cast<CameraResponse&>(view.color) = responses[i];
    const int code = static_cast<int>(std::lround(255 * code_from_linear(responses[i], 1.5, 0)));
    ASSERT_LT(code, 250) << i;
    const double shown = linear_from_code(responses[i], code / 255.0, 0);
    const glm::vec4 pixel = pixel_at(compositor.render(view, plate_u8(code)), 80, 60);
    EXPECT_NEAR(linear_from_code(responses[i], pixel.x, 0) / shown, 0.9, 2e-3) << i;
  }
}

TYPED_TEST(ReceiverGl, ClippedIsACodeWhateverItsLight) {
  // As far above the clipping level as rounding to eight bits leaves it, and as far below.
  FrameView view = linear_view_from_above();
  TypeParam compositor(receiver_scene([](double, double) { return 0.5; }), without_glare());
  for (const TransferFunction transfer : {TransferFunction::srgb, TransferFunction::linear, TransferFunction::hlg}) {
    view.color.transfer = transfer;
    for (const int code : {251, 252}) {
      const double shown = linear_from_code(transfer, code / 255.0);
      view.receiver_light = glm::vec3(static_cast<float>(1.5 * shown));
      const double left = linear_from_code(transfer, pixel_at(compositor.render(view, plate_u8(code)), 80, 60).x) / shown;
      EXPECT_NEAR(left, code < 255 * kClippingCode ? 0.5 : 0.75, 1e-3) << code;
    }
    const PlateReader floats = plate_f32([](int, int) { return glm::vec3(1); });
    view.receiver_light = glm::vec3(10);
    EXPECT_NEAR(linear_from_code(transfer, pixel_at(compositor.render(view, floats), 80, 60).x) / linear_from_code(transfer, 1.0),
                0.5, 1e-3)
        << "float codes go on";
  }
}

TYPED_TEST(ReceiverGl, RatiosThatMakeNoSenseAreBounded) {
  // The processor looks codes up, to a 20 000th.
  const double tolerance = std::is_same_v<TypeParam, CpuCompositor> ? 5e-5 : 1e-5;
  for (const auto& [given, shown] : {std::pair{-0.5, 0.0}, {100.0, 2.0}}) {
    TypeParam compositor(receiver_scene([value = given](double, double) { return value; }), without_glare());
    EXPECT_NEAR(pixel_at(compositor.render(linear_view_from_above(), linear_grey_plate()), 80, 60).x, shown, tolerance) << given;
  }
}

TYPED_TEST(ReceiverGl, WithoutLightThereIsNoShadow) {
  RenderScene scene = receiver_scene([](double, double) { return 0.3; });
  scene.light = constant_light({1, 0, 1}, 3);
  TypeParam compositor(scene, {});
  const glm::vec4 pixel = pixel_at(compositor.render(linear_view_from_above(), linear_grey_plate()), 80, 60);
  EXPECT_NEAR(pixel.x, 0.15, 1e-5);
  EXPECT_NEAR(pixel.y, 0.5, 1e-5) << "no green light: green cannot be shadowed";
}

TYPED_TEST(ReceiverGl, TheObjectHidesTheShadow) {
  RenderScene scene = constant_scene(sphere(0.03, {0, 0, 0.03}), Material{}, glm::vec3(1));
  scene.mesh.materials[0].dielectric_f0 = 0;
  scene.mesh.materials[0].base_color = glm::vec3(0.7f);
  scene.transfer = unshadowed_transfer(scene.mesh, 3);
  add_receiver(scene.transfer, {.min_m = {-0.1f, -0.1f}, .max_m = {0.1f, 0.1f}, .columns = 21, .rows = 21},
               [](double, double) { return 0.0; });
  EXPECT_NEAR(pixel_at(TypeParam(scene, {}).render(linear_view_from_above(), linear_grey_plate()), 80, 60).x, 0.7, 1e-3);
}

}  // namespace
}  // namespace catchlight::render::test
