// Metering on the GPU against a loop in double precision, and whole frames through the tone curve.
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "catchlight/color.hpp"
#include "catchlight/composite.hpp"
#include "catchlight/image.hpp"
#include "catchlight/pixel_rect.hpp"
#include "catchlight/plate.hpp"
#include "catchlight/tone_curve.hpp"
#include "render/frame_view.hpp"
#include "render/passes/tone_pass.hpp"
#include "render/render_scene.hpp"
#include "render/settings.hpp"
#include "tests/support/gl_fixture.hpp"
#include "tests/support/renderers.hpp"

namespace catchlight::render::test {
namespace {

class ToneGl : public GlTest {};

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

/// Larger than the picture, as targets are; what lies beyond is bright and must not count.
GlTexture texture_of(const Image& image) {
  const int width = roomy(image.width), height = roomy(image.height);
  GlTexture texture = make_texture_2d("test light", GL_RGBA32F, width, height);
  const float bright[4] = {1e6f, 1e6f, 1e6f, 1};
  glClearTexImage(texture.id(), 0, GL_RGBA, GL_FLOAT, bright);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture.id(), 0, 0, 0, image.width, image.height, GL_RGB, GL_FLOAT, image.data.data());
  return texture;
}

Image grey(int width, int height, float light) {
  Image image(width, height);
  std::fill(image.data.begin(), image.data.end(), light);
  return image;
}

Image random_light(int width, int height) {
  Image image(width, height);
  std::mt19937 random(7);
  std::normal_distribution<float> stops(-2, 3);
  for (float& value : image.data) value = std::exp2(stops(random));
  return image;
}

void set(Image& image, int x, int y, const glm::vec3& light) {
  for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = light[c];
}

LuminanceHistogram metered(const Image& image) {
  ShaderLibrary shaders;
  return ToneMeter(shaders).measure(texture_of(image), image.width, image.height, kLuminanceWeights);
}

double pixels_in(const LuminanceHistogram& histogram) {
  double pixels = 0;
  for (const auto& bin : histogram.bins) pixels += bin.count;
  return pixels;
}

/// The definitions, in double precision, over pixels that are numbers; percentiles by sorting. `metered_high` gives delta: bins
/// are 1/64 octave wide.
SceneLuminance by_loop(const Image& image, double metered_high) {
  std::vector<double> luminances;
  for (std::size_t i = 0; i < image.data.size(); i += 3) {
    const double luminance = glm::dot(kLuminanceWeights, glm::dvec3(image.data[i], image.data[i + 1], image.data[i + 2]));
    if (!std::isnan(luminance)) luminances.push_back(std::clamp(luminance, 0.0, 0x1p32));
  }
  std::ranges::sort(luminances);
  const auto ranked = [&](double share) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(luminances.size())));
    return luminances[std::max<std::size_t>(rank, 1) - 1];
  };
  SceneLuminance result{0, ranked(0.01), ranked(0.99)};
  const double delta = 1e-3 * std::max(metered_high, 0.5 / 255 / 12.92);
  for (const double luminance : luminances) result.average += std::log(delta + luminance);
  result.average = std::exp(result.average / static_cast<double>(luminances.size())) - delta;
  return result;
}

void expect_as_by_loop(const Image& image, const char* what) {
  const SceneLuminance found = scene_luminance(metered(image)), expected = by_loop(image, found.high);
  EXPECT_NEAR(found.average, expected.average, 2e-5 * expected.average + 1e-12) << what;
  EXPECT_NEAR(found.low, expected.low, 0.016 * expected.low) << what;  // a bin is 1/64 octave
  EXPECT_NEAR(found.high, expected.high, 0.016 * expected.high) << what;
}

TEST_F(ToneGl, MetersAsALoopDoes) {
  expect_as_by_loop(random_light(1, 1), "one pixel");
  expect_as_by_loop(random_light(1, 7), "1 x 7");
  expect_as_by_loop(random_light(641, 479), "641 x 479");
  expect_as_by_loop(grey(641, 479, 1.999f), "sums beyond 32 bits");
  expect_as_by_loop(grey(64, 48, 1.0f), "white");
  expect_as_by_loop(grey(64, 48, 0.0f), "black");
  Image sun = grey(641, 479, 0.2f);
  set(sun, 640, 478, glm::vec3(1e7f));
  expect_as_by_loop(sun, "one sun pixel");
}

TEST_F(ToneGl, EveryPixelCountsOnce) {
  EXPECT_EQ(pixels_in(metered(random_light(641, 479))), 641 * 479);
}

TEST_F(ToneGl, NanCountsForNothingAndInfinityForTheMost) {
  Image image = grey(20, 10, 0.18f);
  set(image, 0, 0, glm::vec3(kNan, 1, 1));
  set(image, 19, 9, glm::vec3(kInf));
  set(image, 5, 5, glm::vec3(-3));
  const LuminanceHistogram histogram = metered(image);
  EXPECT_EQ(pixels_in(histogram), 199);
  EXPECT_EQ(histogram.bins.front().count, 1u) << "what is darker than black is black";
  EXPECT_EQ(histogram.bins.back().count, 1u);
  EXPECT_TRUE(std::isfinite(scene_luminance(histogram).average));
}

TEST_F(ToneGl, TheSameFrameGivesTheSameCounts) {
  const Image image = random_light(320, 240);
  const LuminanceHistogram a = metered(image), b = metered(image);
  EXPECT_EQ(std::memcmp(&a.bins, &b.bins, sizeof a.bins), 0);
}

// --- whole frames -----------------------------------------------------------------------------------------------------

CompositorSettings automatic(double key = 0.18) {
  CompositorSettings settings;
  settings.tone = {.enabled = true, .key = key};
  return settings;
}

RenderScene ball(float radiance = 1) {
  return constant_scene(sphere(0.03, {0, 0, 0.03}), Material{}, glm::vec3(radiance));
}

FrameView without_pose(FrameView view = linear_view_from_above()) {
  view.has_pose = false;
  return view;
}

void expect_finite_codes(const Composite& composite, double most = 1) {
  ASSERT_FALSE(composite.rgba.empty());
  for (const float value : composite.rgba) ASSERT_TRUE(value >= 0 && value <= most) << value;
}

template <typename Renderer>
using CompositorToneGl = EachRenderer<Renderer>;
TYPED_TEST_SUITE(CompositorToneGl, Renderers, RendererNames);

TYPED_TEST(CompositorToneGl, AFlatPlateBecomesTheKey) {
  for (const float light : {0.004f, 0.05f, 0.9f}) {
    const Composite composite =
        TypeParam(ball(), automatic()).render(without_pose(), plate_f32([&](int, int) { return glm::vec3(light); }));
    EXPECT_EQ(composite.rect, (PixelRect{0, 0, 160, 120}));
    EXPECT_NEAR(pixel_at(composite, 159, 119).g, 0.18, 1e-5) << light;
    EXPECT_EQ(pixel_at(composite, 0, 0).a, 1) << "every pixel changed";
  }
}

TYPED_TEST(CompositorToneGl, CodesGoThroughTheFootagesResponse) {
  FrameView view = view_from_above();
  view.has_pose = false;
  const Composite composite = TypeParam(ball(), automatic()).render(view, plate_u8(90));
  EXPECT_NEAR(pixel_at(composite, 80, 60).r, srgb_from_linear(0.18), 1e-5);
}

/// Plate and object alike: the curve's twin on the CPU, of the light in the layers.
TYPED_TEST(CompositorToneGl, PlateAndObjectGoThroughOneCurve) {
  const FrameView view = linear_view_from_above();
  const PlateReader plate =
      plate_f32([](int x, int y) { return glm::vec3(0.001f * static_cast<float>(x + 1), 0.3f, 0.004f * static_cast<float>(y)); });
  TypeParam compositor(ball(3), automatic());
  const Composite composite = compositor.render(view, plate);
  const Layers layers = *compositor.render(view, plate, true).layers;
  const Image recomposed = recompose(layers);
  int covered = 0;
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) {
      glm::dvec3 light;
      for (int c = 0; c < 3; ++c) light[c] = recomposed.pixel(x, y)[c];
      covered += layers.object.pixel(x, y)[3] > 0;
      const glm::dvec3 expected = composite.tone_wanted(light, kLuminanceWeights, false);
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(pixel_at(composite, x, y)[c], expected[c], 1e-5 * (1 + expected[c])) << x << ", " << y;
    }
  }
  EXPECT_GT(covered, 300);
}

TYPED_TEST(CompositorToneGl, IsDrawnWithTheExposureItHasAdaptedTo) {
  FrameView view = without_pose();
  view.tone = ToneCurve{0.5, 1};
  const Composite composite = TypeParam(ball(), automatic()).render(view, linear_grey_plate());
  EXPECT_NEAR(pixel_at(composite, 3, 3).r, 0.25, 1e-6);
  EXPECT_NEAR(composite.tone_wanted.gain, 0.18 / 0.5, 1e-6) << "what it calls for itself";
}

TYPED_TEST(CompositorToneGl, MeteringAloneSaysTheSame) {
  const FrameView view = linear_view_from_above();
  TypeParam compositor(ball(), automatic());
  EXPECT_EQ(compositor.meter(view, linear_grey_plate()).gain, compositor.render(view, linear_grey_plate()).tone_wanted.gain);
}

TYPED_TEST(CompositorToneGl, WithoutToneAFrameWithoutPoseIsLeftAlone) {
  EXPECT_TRUE(TypeParam(ball(), {}).render(without_pose(), linear_grey_plate()).rect.empty());
}

TYPED_TEST(CompositorToneGl, LayersAreTheScenesLight) {
  const Composite composite = TypeParam(ball(), automatic()).render(linear_view_from_above(), linear_grey_plate(), true);
  EXPECT_EQ(composite.layers->plate.pixel(0, 0)[0], 0.5f);
}

TYPED_TEST(CompositorToneGl, ExtremePlatesGiveFiniteCodes) {
  FrameView view = view_from_above();
  view.has_pose = false;
  TypeParam compositor(ball(), automatic());
  expect_finite_codes(compositor.render(view, plate_u8(0)));
  EXPECT_EQ(pixel_at(compositor.render(view, plate_u8(0)), 7, 7).r, 0) << "black stays black";
  expect_finite_codes(compositor.render(view, plate_u8(255)));
  expect_finite_codes(compositor.render(view, plate_u8([](int x, int y) { return glm::ivec3(x == 9 && y == 9 ? 255 : 0); })));
  const auto with = [](float light) {
    return plate_f32([light](int x, int y) { return glm::vec3(x == 9 && y == 9 ? light : 0.3f); });
  };
  for (const float light : {kNan, kInf, -kInf, 1e30f}) {
    const Composite composite = compositor.render(without_pose(), with(light));
    expect_finite_codes(composite, 1e9);
    EXPECT_NEAR(pixel_at(composite, 0, 0).r, 0.18, 0.001) << "one texel hardly counts: " << light;
  }
}

TYPED_TEST(CompositorToneGl, TwentyStopsEitherWayGiveFiniteCodes) {
  FrameView view = view_from_above();
  for (const float ev : {-20.0f, 20.0f}) {
    view.exposure = glm::vec3(std::exp2(ev));
    const Composite composite = TypeParam(ball(), automatic()).render(view, plate_u8(120));
    expect_finite_codes(composite);
    EXPECT_GT(pixel_at(composite, 80, 60).r, ev > 0 ? 0.99f : -1.0f);
  }
}

TYPED_TEST(CompositorToneGl, AnObjectThatIsNoNumberLeavesTheFrameSane) {
  RenderScene scene = ball();
  scene.light.front() = glm::vec3(kInf);
  const Composite composite = TypeParam(scene, automatic()).render(view_from_above(), plate_u8(120));
  expect_finite_codes(composite);
  EXPECT_GT(pixel_at(composite, 0, 0).r, 0.3);
}

}  // namespace
}  // namespace catchlight::render::test
