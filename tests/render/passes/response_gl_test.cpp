// Footage coded by a measured curve: the shader's light and codes against the curve's own on the CPU.
#include <cmath>

#include "catchlight/composite.hpp"
#include "catchlight/response.hpp"
#include "render/frame_view.hpp"
#include "render/render_scene.hpp"
#include "tests/support/gl_fixture.hpp"
#include "tests/support/renderers.hpp"

namespace catchlight::render::test {
namespace {

template <typename Renderer>
using ResponseGl = EachRenderer<Renderer>;
TYPED_TEST_SUITE(ResponseGl, Renderers, RendererNames);

/// Another curve in each channel, with light beyond 1 in the last.
std::shared_ptr<const ResponseCurve> curve_of(int codes) {
  ResponseCurve::Tables tables;
  for (int i = 0; i < codes; ++i) {
    const double code = static_cast<double>(i) / (codes - 1);
    tables[0].push_back(static_cast<float>(std::pow(code, 2.4)));
    tables[1].push_back(static_cast<float>(0.1 * code + 0.9 * code * code * code));
    tables[2].push_back(static_cast<float>((std::exp2(8 * code) - 1) / 31 - 0.002));
  }
  return std::make_shared<ResponseCurve>(tables);
}

/// Half the receiver's light, in the middle of the picture.
RenderScene half_shadow(double ratio) {
  RenderScene scene = constant_scene(square({-1e-4, -1e-4}, {1e-4, 1e-4}, -10.0), Material{}, glm::vec3(1));
  const auto inner = [ratio](double x, double y) { return std::max(std::abs(x), std::abs(y)) < 0.06 ? ratio : 1.0; };
  add_receiver(scene.transfer, {.min_m = {-0.1f, -0.1f}, .max_m = {0.1f, 0.1f}, .columns = 41, .rows = 41}, inner);
  return scene;
}

TYPED_TEST(ResponseGl, HalfTheLightHasTheCurvesOwnCode) {
  TypeParam compositor(half_shadow(0.5), {});
  for (const int codes : {256, 65536}) {
    FrameView view = view_from_above();
    view.color.curve = curve_of(codes);
    for (const float code : {0.05f, 0.3f, 0.6f, 0.95f}) {
      const Composite composite = compositor.render(view, plate_f32([code](int, int) { return glm::vec3(code); }));
      for (int c = 0; c < 3; ++c) {
        const double light = view.color.curve->linear_from_code(static_cast<double>(code), c);
        // What is below 0 is no light that a shadow could take.
        const double expected = view.color.curve->code_from_linear(light > 0 ? 0.5 * light : light, c);
        EXPECT_NEAR(pixel_at(composite, 80, 60)[c], expected, 0.05 / 255) << codes << " codes, channel " << c << " code " << code;
      }
    }
  }
}

TYPED_TEST(ResponseGl, All256CodesSurviveDecodeAndEncode) {
  TypeParam compositor(half_shadow(1.0 - 2e-6), {});
  FrameView view = view_from_above();
  view.color.curve = curve_of(256);
  const Composite composite = compositor.render(view, plate_u8([](int x, int y) { return glm::ivec3((16 * y + x) % 256); }));
  for (int y = 52; y < 68; ++y)
    for (int x = 72; x < 88; ++x)
      for (int c = 0; c < 3 && holds(composite, x, y); ++c)
        EXPECT_EQ(std::lround(pixel_at(composite, x, y)[c] * 255), (16 * y + x) % 256) << "channel " << c;
}

TYPED_TEST(ResponseGl, TheCurveCanChangeFromFrameToFrame) {
  TypeParam compositor(half_shadow(0.5), {});
  const auto code_with = [&](const std::shared_ptr<const ResponseCurve>& curve) {
    FrameView view = view_from_above();
    view.color.curve = curve;
    return pixel_at(compositor.render(view, plate_u8(200)), 80, 60).x;
  };
  const float before = code_with(curve_of(256)), between = code_with(nullptr);
  EXPECT_NE(before, between);
  EXPECT_EQ(before, code_with(curve_of(256)));
}

}  // namespace
}  // namespace catchlight::render::test
