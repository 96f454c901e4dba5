// Defocus and motion blur of the virtual layer: widths in closed form, energy, and what must not change.
#include "catchlight/camera.hpp"
#include "catchlight/composite.hpp"
#include "catchlight/plate.hpp"
#include "catchlight/projection.hpp"
#include "catchlight/rigid_transform.hpp"
#include "render/frame_view.hpp"
#include "render/passes/camera_blur_pass.hpp"
#include "render/render_scene.hpp"
#include "tests/support/gl_fixture.hpp"
#include "tests/support/renderers.hpp"

#include <algorithm>
#include <cmath>

namespace catchlight::render::test {
namespace {

template <typename Renderer>
using CameraBlurGl = EachRenderer<Renderer>;
TYPED_TEST_SUITE(CameraBlurGl, Renderers, RendererNames);

/// A white square 24 x 20 px large in the middle of a black plate, seen straight from above; codes are light.
RenderScene white_square() {
  Material white;
  white.base_color = glm::vec3(1);
  white.dielectric_f0 = 0;
  constexpr double kPx_m = 0.5 / 200;
  return constant_scene(square({-12 * kPx_m, -10 * kPx_m}, {12 * kPx_m, 10 * kPx_m}, 0), white, glm::vec3(1));
}

PlateReader black() {
  return plate_f32([](int, int) { return glm::vec3(0); });
}

template <typename Renderer>
Composite seen(const FrameView& view) {
  Renderer compositor(white_square(), without_glare());
  return compositor.render(view, black());
}

double sum_of(const Composite& composite) {
  double sum = 0;
  for (std::size_t i = 0; i < composite.rgba.size(); i += 4) sum += composite.rgba[i];
  return sum;
}

/// Covariance of where the light is.
glm::dmat2 spread_of(const Composite& composite) {
  double sum = 0;
  glm::dvec2 first(0.0);
  glm::dmat2 second(0.0);
  for (int y = 0; y < composite.rect.height; ++y)
    for (int x = 0; x < composite.rect.width; ++x) {
      const double light = composite.rgba[4 * static_cast<std::size_t>(y * composite.rect.width + x)];
      const glm::dvec2 at(x, y);
      sum += light, first += light * at, second += light * glm::outerProduct(at, at);
    }
  return second / sum - glm::outerProduct(first / sum, first / sum);
}

FrameView moving(const glm::dvec2& way_px) {
  FrameView view = linear_view_from_above();
  view.effects.motion.shift_m = glm::dvec3(way_px * (0.5 / 200), 0);
  return view;
}

TEST(DiscreteGaussian, HasExactlyTheVarianceItIsAskedFor) {
  for (const double variance : {0.02, 0.1, 0.5, 1.0, 4.0, 25.0, 400.0}) {
    const std::vector<float> weights = discrete_gaussian(variance);
    double sum = weights[0], second = 0;
    for (std::size_t n = 1; n < weights.size(); ++n) {
      sum += 2.0 * weights[n];
      second += 2.0 * weights[n] * static_cast<double>(n * n);
    }
    EXPECT_NEAR(sum, 1, 1e-5) << variance;
    EXPECT_NEAR(second / variance, 1, 5e-3) << variance;  // what the cut tail had
  }
}

TEST(DiscreteGaussian, TwiceIsOnceWithBothVariances) {
  const std::vector<float> one = discrete_gaussian(0.8), both = discrete_gaussian(1.6);
  const auto at = [&](int n) { return std::abs(n) < static_cast<int>(one.size()) ? double{one[std::abs(n)]} : 0.0; };
  for (int n = 0; n < static_cast<int>(both.size()); ++n) {
    double twice = 0;
    for (int k = -20; k <= 20; ++k) twice += at(k) * at(n - k);
    EXPECT_NEAR(twice, both[static_cast<std::size_t>(n)], 2e-4) << n;
  }
}

TYPED_TEST(CameraBlurGl, DefocusAddsItsVarianceAlongBothAxesAndKeepsTheEnergy) {
  const Composite sharp = seen<TypeParam>(linear_view_from_above());
  for (const double variance : {0.05, 0.3, 2.0, 9.0}) {
    FrameView view = linear_view_from_above();
    view.effects.defocus_px2 = variance;
    const Composite blurred = seen<TypeParam>(view);
    EXPECT_NEAR(sum_of(blurred) / sum_of(sharp), 1, 1e-4) << variance;
    const glm::dmat2 added = spread_of(blurred) - spread_of(sharp);
    EXPECT_NEAR(added[0][0] / variance, 1, 0.01) << variance;
    EXPECT_NEAR(added[1][1] / variance, 1, 0.01) << variance;
    EXPECT_NEAR(added[0][1], 0, 1e-3) << variance;
  }
}

TYPED_TEST(CameraBlurGl, MotionAddsATwelfthOfItsSquareAlongItsWay) {
  const Composite sharp = seen<TypeParam>(linear_view_from_above());
  for (const glm::dvec2 way : {glm::dvec2(1, 0), {3, 0}, {0, 5.5}, {8, 0}, {9.3, 0}, {0, 20}}) {
    const Composite blurred = seen<TypeParam>(moving(way));
    EXPECT_NEAR(sum_of(blurred) / sum_of(sharp), 1, 1e-4);
    const glm::dmat2 added = spread_of(blurred) - spread_of(sharp);
    for (int i = 0; i < 2; ++i)
      EXPECT_NEAR(added[i][i], way[i] * way[i] / 12, 0.01 * way[i] * way[i] / 12 + 2e-3) << way.x << ", " << way.y;
  }
}

TYPED_TEST(CameraBlurGl, MotionAslantBlursAlongItsWayAndLessThanHalfAPixelAcross) {
  const Composite sharp = seen<TypeParam>(linear_view_from_above());
  for (const glm::dvec2 way : {glm::dvec2(6, 6), {8, 3}, {-4, 9}}) {
    const glm::dmat2 added = spread_of(seen<TypeParam>(moving(way))) - spread_of(sharp);
    const glm::dvec2 along = glm::normalize(way), across(-along.y, along.x);
    const double expected = glm::dot(way, way) / 12;
    EXPECT_NEAR(glm::dot(along, added * along) / expected, 1, 0.08);
    EXPECT_GE(glm::dot(across, added * across), -1e-3);
    EXPECT_LE(glm::dot(across, added * across), 0.17) << "the mean of linear interpolation's own, 1/6 px^2";
  }
}

TYPED_TEST(CameraBlurGl, ABlurredEdgeIsTheBoxesRamp) {
  // 9 px of way: an upright edge becomes a straight ramp 9 px wide, but that steps of whole pixels cannot show where in a pixel
  // it begins: half a pixel of ramp, 1/2 * 1/2 * 1/2 / 9 of the light.
  const Composite blurred = seen<TypeParam>(moving({9, 0}));
  const double left = 80 - 12;  // the edge, in pixels from the picture's left
  for (int x = 58; x < 76; ++x) {
    double covered = 0;  // a pixel's own square over the ramp, by 1000 points
    for (int i = 0; i < 1000; ++i) covered += std::clamp((x + (i + 0.5) / 1000 - left) / 9 + 0.5, 0.0, 1.0) / 1000;
    EXPECT_NEAR(pixel_at(blurred, x, 60).x, covered, 1.0 / 8 / 9) << x;
  }
}

TYPED_TEST(CameraBlurGl, AStillViewIsTheSameToTheLastBit) {
  FrameView view = linear_view_from_above();
  TypeParam compositor(white_square(), without_glare());
  compositor.render(view, black());  // lights the object
  const Composite plain = compositor.render(view, black());
  const std::size_t passes = compositor.pass_times().size();
  view.effects.motion.shift_m = {0.4 * 0.5 / 200, 0, 0};  // less than half a pixel
  const Composite still = compositor.render(view, black());
  EXPECT_EQ(still.rgba, plain.rgba);
  EXPECT_EQ(compositor.pass_times().size(), passes) << "no pass for nothing";
  EXPECT_TRUE(plan_camera_blur(linear_view_from_above(), distortion_limit({}), {glm::vec3(-1), glm::vec3(1)}).empty());
}

TYPED_TEST(CameraBlurGl, TheShadowIsBlurredAsTheObjectIs) {
  RenderScene scene = white_square();
  add_receiver(scene.transfer, {.min_m = {-0.15f, -0.1f}, .max_m = {0.15f, 0.1f}, .columns = 121, .rows = 81},
               [](double x, double) { return std::abs(x) < 0.08 ? 0.5 : 1.0; });
  TypeParam compositor(scene, without_glare());
  FrameView view = moving({12, 0});
  const Composite sharp = compositor.render(linear_view_from_above(), linear_grey_plate()),
                  blurred = compositor.render(view, linear_grey_plate());
  const auto light = [](const Composite& composite, int x) {
    return holds(composite, x, 60) ? double{pixel_at(composite, x, 60).x} : 0.5;
  };
  double sharp_sum = 0, blurred_sum = 0, steepest_sharp = 0, steepest_blurred = 0;
  for (int x = 30; x < 61; ++x) {  // as far as the object's blur does not reach
    sharp_sum += light(sharp, x), blurred_sum += light(blurred, x);
    steepest_sharp = std::max(steepest_sharp, light(sharp, x) - light(sharp, x + 1));
    steepest_blurred = std::max(steepest_blurred, light(blurred, x) - light(blurred, x + 1));
  }
  EXPECT_NEAR(blurred_sum / sharp_sum, 1, 0.01);
  EXPECT_LT(steepest_blurred, 0.26 / 12 * 1.1) << "a quarter of light over twelve pixels";
  EXPECT_GT(steepest_sharp, 2 * steepest_blurred);
}

TYPED_TEST(CameraBlurGl, BlurAtTheFramesEdgeAndOfExtremeLightStaysFinite) {
  FrameView view = moving({500, 300});
  view.camera_from_tag.translation_m.x = 0.19;
  view.effects.defocus_px2 = 1e6;
  view.exposure = glm::vec3(1e6f);
  const Composite composite = seen<TypeParam>(view);
  ASSERT_FALSE(composite.rect.empty());
  EXPECT_EQ(composite.rect, intersect(composite.rect, {0, 0, 160, 120}));
  for (const float value : composite.rgba) ASSERT_TRUE(std::isfinite(value));
}

// What an affine field leaves out is of second order. At the plane's edge, half = 50 px from its middle, at f = 600 px and depth
// 0.6 m: of the turn, turn * half^2 / f = 0.01 * 50^2 / 600 = 0.042 px; of the shift, f / z * shift * d^2 with d = 0.05 * 0.6 /
// 0.6 its share of depth, 1000 * 0.0045 * 0.0025 = 0.011 px. Together 0.053 px, 2 % of the 2.7 px that the longest way has.
TEST(MotionField, IsTheWayOfEveryPointOfAPlaneToAFiftiethOfTheLongest) {
  CameraModel camera{640, 480, 600, 600, 319.5, 239.5, {-0.2, 0.05}};
  const RigidTransform pose{glm::dmat3(1, 0, 0, 0, -0.8, -0.6, 0, 0.6, -0.8), {0.02, -0.03, 0.6}};
  const TagMotion motion{{0.004, -0.01, 0.02}, {0.004, 0.002, -0.003}};
  std::vector<glm::dvec3> points;
  for (const double x : {-0.05, 0.0, 0.05})
    for (const double y : {-0.05, 0.0, 0.05}) points.emplace_back(x, y, 0);
  const DistortionLimit limit = distortion_limit(camera);
  const MotionField field = fit_motion(camera, limit, pose, motion, points);
  const auto px = [&](const glm::dvec3& p) {
    const glm::dvec3 d = distorted(camera, limit, p);
    return glm::dvec2(600 * d.x / d.z + 319.5, 600 * d.y / d.z + 239.5);
  };
  double worst = 0, longest = 0;
  for (const glm::dvec3& point : points) {
    const glm::dvec3 middle = pose * point, half = 0.5 * (glm::cross(motion.turn_rad, middle) + motion.shift_m);
    const glm::dvec2 way = px(middle + half) - px(middle - half);
    worst = std::max(worst, glm::distance(field.at(px(middle)), way));
    longest = std::max(longest, glm::length(way));
  }
  EXPECT_GT(longest, 2.5);
  EXPECT_LT(worst, 0.02 * longest);
}

}  // namespace
}  // namespace catchlight::render::test
